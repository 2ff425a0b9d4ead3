#pragma once
// Total Lagrangian MPM (de Vaucorbeil, Nguyen & Hutchinson 2020) with nodes that keep their motion:
// of a body with `frame = "material"` the nodes lie in the body, at the places X_i of the grid when
// it was filled, and each keeps its displacement u_i and velocity v_i from step to step. Nothing is
// mapped there and back. With N_ip = N_i(X_p) for ever a step is
//   F_p = 1 + sum_i u_i (x) grad_X N_ip,   x_p = X_p + sum_i u_i N_ip                    (M1)
//   f_i = - sum_p V_p sigma_p F_p^-T grad_X N_ip,   as V_p sigma_p F_p^-T = V0_p P_p     (M2)
//   v_i += dt (f_i / m_i + g),   u_i += dt v_i                                          (M3)
//   L dt = (F_p - F_p before) (F_p before)^-1, for the material                         (M4)
// v_i is that of the middle of a step. The work of (M2) over a step is that of the stress at its
// start, so that kinetic energy changes by exactly the work of all forces with the mean velocity.
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

/// f(m, x, v) for the nodes of a patch that it owns: mass [kg], place [m], velocity [m/s].
template <int D, class F>
void for_each_kept_node(TileGrid<D>& grid, const Patch<D>& patch, F&& f) {
  const NodeBlock<D> block = grid.block(patch);
  double own[BlockShape<D>::nodes_max];
  own_nodes(grid, patch, own);
  for (int n = 0; n < block.count; ++n)
    if (const double m = own[n] * block.records[n][mass_at]; m > 0.0)
      f(m, place_of_kept(grid, patch, block, n), in_space<D>(block.vector(n, velocity_at)));
}

/// (M3): the nodes of a block move with the velocities that they have by now; kinetic energy and
/// momentum after the step.
template <int D>
void move_kept_nodes(const Domain<D>& domain, const NodeBlock<D>& block, const double* own,
                     PatchSums<D>& sums) {
  double second = 0.0, kinetic = 0.0, gained = 0.0;
  for (int n = 0; n < block.count; ++n) {
    const double* const numbers = block.records[n];
    const double m = own[n] * numbers[mass_at];
    for (int a = 0; a < D; ++a) {
      const double v = numbers[velocity_at + a], dv = numbers[increment_at + a];
      block.displacements[n][a] += domain.time_step * v;
      kinetic += 0.5 * m * v * v;
      second += 0.5 * m * dv * dv;
      gained += m * dv * (v - 0.5 * dv);
      sums.momentum[a] += m * v;
    }
  }
  sums.kinetic = kinetic;
  sums.second_order = second;
  // Affine transfers count all that kinetic energy loses, and what forces have given against it.
  if (is_affine(domain.transfer)) sums.transferred = -gained;
}

}  // namespace mpm
