#pragma once
// Total Lagrangian MPM (de Vaucorbeil, Nguyen & Hutchinson 2020) with nodes that keep their motion:
// of a body with `frame = "material"` the nodes lie in the body, at the places X_i of the grid when
// it was filled, and each keeps its displacement u_i and velocity v_i from step to step. Nothing is
// mapped there and back. With N_ip = N_i(X_p), which change only where nodes are laid anew
// (run/renew_reference.hpp), a step is
//   F_p = 1 + sum_i u_i (x) grad_X N_ip,   x_p = X_p + sum_i u_i N_ip                    (M1)
//   f_i = - sum_p V_p sigma_p F_p^-T grad_X N_ip,   as V_p sigma_p F_p^-T = V0_p P_p     (M2)
//   v_i += dt' (f_i / m_i + g),   u_i += dt v_i                                         (M3)
//   L dt = (F_p - F_p before) (F_p before)^-1, for the material                         (M4)
//   u_i += (dt before^2 - dt^2) / 8 (a_i - a of the body), where the step changes         (M5)
// v_i is that of the middle of a step, so that forces act from the middle of the step before to
// that of this one, dt' = (dt + dt before) / 2 (central differences), for half a step at the start.
// For the ledger kinetic energy is told at the end of the step, which is as much further. External
// forces work along what the nodes go in the step; the rest of what energy changes by is that of
// time stepping.
#include "mpm/domain.hpp"
#include "mpm/step/transfer/transfer.hpp"
#include "mpm/walls/mirror.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {

/// First moment of what the masses of a patch's own nodes are displaced by, sum m_i u_i [kg m].
template <int D>
Vector3 displaced_moment(const NodeBlock<D>& block, const double* own) {
  Vec<double, D> sum = Vec<double, D>::zero();
  for (int n = 0; n < block.count; ++n)
    for (int a = 0; a < D; ++a)
      sum[a] += own[n] * block.records[n][mass_at] * block.displacements[n][a];
  return in_space<D>(sum);
}

/// The place of a node of a patch that keeps its nodes [m].
template <int D>
Vector3 place_of_kept(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                      int node) {
  Vec<double, D> u;
  for (int a = 0; a < D; ++a) u[a] = block.displacements[node][a];
  return place_of(grid, patch, node) + in_space<D>(u);
}

/// f(m, x, v) for the nodes of a patch that it owns: mass [kg], place [m], velocity [m/s]. The mass
/// of a node beyond a wall, which its image has too, moves with the node.
template <int D, class F>
void for_each_kept_node(TileGrid<D>& grid, const Patch<D>& patch, F&& f) {
  const NodeBlock<D> block = grid.block(patch);
  const auto node = [&](double m, int n) {
    if (m != 0.0)
      f(m, place_of_kept(grid, patch, block, n), in_space<D>(block.vector(n, velocity_at)));
  };
  double own[BlockShape<D>::nodes_max];
  own_nodes(grid, patch, own);
  for (int n = 0; n < block.count; ++n) node(own[n] * block.records[n][mass_at], n);
  for_each_ghost_node(grid, patch, [&](int beyond, int image, const WallImage<D>&) {
    if (!patch.counts(beyond)) return;
    node(block.records[beyond][mass_at], beyond);
    node(-block.records[beyond][mass_at], image);
  });
}

/// What walls hold of vectors of a patch's nodes: those on them, and those beyond by their images.
template <int D>
void hold_kept_nodes(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                     int at = velocity_at) {
  for_each_constrained_node(grid, patch, [&](int node, unsigned constrained) {
    for (int a = 0; a < D; ++a)
      if (constrained >> a & 1u) block.records[node][at + a] = 0.0;
  });
  reflect_at_walls(grid, patch, block, at);
}

/// For how long the forces of a step act on nodes that are kept, or not [s].
template <int D>
double time_of_forces(const Domain<D>& domain, bool keeps) {
  return keeps ? 0.5 * (domain.time_step + domain.step_before) : domain.time_step;
}
template <int D>
double time_of_forces(const Domain<D>& domain, const Patch<D>& patch) {
  return time_of_forces(domain, patch.keeps);
}

/// Where the step changes nodes go by this more along their acceleration against that of their body
/// [s^2], (M5): leapfrog keeps K + U - dt^2 / 8 sum f_i^2 / m_i rather than K + U (Hairer, Lubich &
/// Wanner 2006, chapter IX), so that a step that changes alone would make or take the difference.
inline double shift_between(double before, double now) {
  // Steps before an output differ by rounding.
  if (!(before > 0.0) || std::abs(before - now) <= 1e-9 * now) return 0.0;
  return 0.125 * (before * before - now * now);
}

/// What the step's change adds to the displacements of a block, (M5). Returns the work of the
/// forces along it [J]: it changes what is stored and no velocity, and update_in_body() takes half
/// of it for that of a velocity.
template <int D>
double shift_kept_nodes(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block,
                        const double* own) {
  const double shift = domain.shift, acts = time_of_forces(domain, true);
  if (shift == 0.0) return 0.0;
  const Vector3 of_body = acceleration_of(domain.kept_spins, patch.body);
  double work = 0.0;
  for (int n = 0; n < block.count; ++n) {
    const double m = own[n] * block.records[n][mass_at];
    for (int a = 0; a < D; ++a) {
      const double acceleration = block.records[n][increment_at + a] / acts,
                   further = shift * (acceleration - of_body[a]);
      block.displacements[n][a] += further;
      work += m * acceleration * further;
    }
  }
  return work;
}

/// The nodes of a block go with the velocities that they have by now, (M3); kinetic energy and
/// momentum in the middle of the step. Returns by how much the first is more than it was [J].
template <int D>
double move_kept_nodes(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block,
                       const double* own, PatchSums<D>& sums) {
  double kinetic = 0.0, gained = 0.0;
  for (int n = 0; n < block.count; ++n) {
    const double* const numbers = block.records[n];
    const double m = own[n] * numbers[mass_at];
    for (int a = 0; a < D; ++a) {
      const double v = numbers[velocity_at + a], dv = numbers[increment_at + a];
      block.displacements[n][a] += domain.time_step * v;
      kinetic += 0.5 * m * v * v;
      gained += m * dv * (v - 0.5 * dv);
      sums.momentum[a] += m * v;
    }
  }
  // The mass of nodes beyond walls is with their images, which move the other way.
  for_each_ghost_node(domain.grid, patch, [&](int beyond, int image, const WallImage<D>&) {
    const double m = patch.counts(beyond) ? block.records[beyond][mass_at] : 0.0;
    for (int a = 0; a < D; ++a)
      sums.momentum[a] +=
          m * (block.records[beyond][velocity_at + a] - block.records[image][velocity_at + a]);
  });
  sums.kinetic = kinetic;
  return gained;
}

/// What the ledger has of a patch whose nodes have moved, of which loads, gravity and damping have
/// their sums: no second order is left, as these have all their work with the velocities of the
/// step. That of stress comes with update_in_body().
template <int D>
void count_kept_nodes(const Domain<D>& domain, double gained, PatchSums<D>& sums) {
  const double first = sums.gravity_first + sums.load_first + sums.damping_first;
  sums.second_order = sums.gravity_second + sums.load_second + sums.damping_second;
  const double external = first + sums.second_order;
  sums.force_work = gained - external - sums.surface_push - sums.surface_rub;
  sums.kept_ahead += 0.5 * external;
  // Affine transfers count all that kinetic energy loses, and what forces have given against it.
  if (is_affine(domain.transfer)) sums.transferred -= gained;
}

}  // namespace mpm
