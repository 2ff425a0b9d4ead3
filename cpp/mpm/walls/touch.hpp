#pragma once
// Walls that push back what touches them and let it part, with friction. A particle overlaps the
// plane of a face by o_p = l_p - b_p - z_p: half its edge, less what its surface is set back, less
// the height of its centre. It is pushed along the normal by a spring as bodies are by rigid ones
// (decision 0054), of the stiffness k_p = rho c^2 A_p / e_p, the edge's area over its length, at
// the middle of the overlap. At a node the springs come to
//   F_i = sum_p N_i k_p o_p, K_i = sum_p N_i k_p,
// and over a step, with the approach u at its end, to F_i + K_i u dt / 4 (share_of_approach);
// friction takes up to mu of that (eqs. 14-15), no more than what brings the node to rest.
// Where contact goes by impulses the springs only say which nodes are touched: on the face and
// beyond it approach is stopped, eqs. (6)-(7), the wall being a body of infinite mass.
#include "mpm/contact/contact_node.hpp"
#include "mpm/contact/node_solver.hpp"
#include "mpm/contact/response.hpp"
#include "mpm/contact/springs.hpp"
#include "mpm/contact/tile_particles.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/walls/mirror.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {

/// A particle that overlaps a face. Lengths in cells.
struct WallTouch {
  int axis, side;
  double overlap, half;  // half its edge
  double inward() const { return side == 0 ? 1.0 : -1.0; }
};

/// f(touch) for the faces that a particle overlaps.
template <int D, class F>
void for_each_wall_touch(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
                         std::uint32_t row, F&& f) {
  constexpr double widest = 1.0;  // an edge of two cells, as bodies see it (SurfaceSum::cut)
  for (int axis = 0; axis < D; ++axis)
    for (const int side : {0, 1}) {
      if (grid.walls.face[axis][side] != Wall::contact) continue;
      const double x = grid.among_nodes(pool.x(axis)[row], axis);
      const double height = side == 0 ? x : grid.walls.cells[static_cast<std::size_t>(axis)] - x;
      if (height >= widest) continue;
      const Batch<contact_lanes> volume(double{pool.volume()[row]});
      const double edge = particle_edge<D>(volume, body.mean_edge)[0] / grid.cell_size;
      const double half = std::min(0.5 * edge, widest);
      // Read here, as who sets it back does so face by face.
      const double back = pool.set_back < 0 ? 0.0 : pool.columns.component(pool.set_back)[row];
      const double overlap = half * (1.0 - back) - height;
      if (overlap > 0.0) f(WallTouch{axis, side, overlap, half});
    }
}

/// The shares of a force that the nodes along an axis have which a particle's cell reaches.
template <BasisModel B>
using SharesAlong = std::array<double, B::nodes>;

/// Those of the particle's own functions at x from its cell's own node [cells].
template <BasisModel B>
SharesAlong<B> shares_of(const B& basis, double x) {
  SharesAlong<B> shares;
  for (int k = 0; k < B::nodes; ++k)
    shares[static_cast<std::size_t>(k)] = shape_along(basis, x - (k - B::before));
  return shares;
}
/// Those of a point at `place`, for nodes that the particle at x reaches: what others would have
/// has the one of these nearest to the face, which is `face` from the cell's own node.
template <BasisModel B>
SharesAlong<B> shares_across(const B& basis, double x, double place, int face) {
  SharesAlong<B> shares = shares_of(basis, x);
  int nearest = -1;
  double rest = 1.0;
  for (int k = 0; k < B::nodes; ++k) {
    double& share = shares[static_cast<std::size_t>(k)];
    if (!(share > 0.0)) continue;
    const auto off = [&](int node) { return std::abs(node - B::before - face); };
    if (nearest < 0 || off(k) < off(nearest)) nearest = k;
    share = shape_along(basis, place - (k - B::before));
    rest -= share;
  }
  shares[static_cast<std::size_t>(nearest)] += rest;
  return shares;
}

/// Add the spring of a particle to the nodes of its patch.
template <BasisModel B, int D>
void add_wall_spring(const B& basis, const TileGrid<D>& grid, const Body<D>& body,
                     const ParticlePool<D>& pool, const Patch<D>& patch, const NodeBlock<D>& block,
                     const CellRange<D>& cell, std::uint32_t row, const WallTouch& touch) {
  const auto normal = static_cast<std::size_t>(touch.axis);
  std::array<SharesAlong<B>, D> along;
  for (std::size_t a = 0; a < D; ++a) {
    const double x =
        grid.among_nodes(pool.x(static_cast<int>(a))[row], static_cast<int>(a)) - cell.cell[a];
    const int face = (touch.side == 0 ? 0 : grid.walls.cells[a]) - cell.cell[a];
    along[a] = a == normal
                   ? shares_across(basis, x, face - touch.inward() * 0.5 * touch.overlap, face)
                   : shares_of(basis, x);
  }
  const double edge = 2.0 * touch.half * grid.cell_size, overlap = touch.overlap * grid.cell_size;
  const double all = body.stiffness * std::pow(edge, D - 2);  // a modulus, an area over a length
  Index<D> low{}, high;
  high.fill(B::nodes - 1);
  for_each_index<D>(low, high, [&](Index<D> k) {
    double stiffness = all;
    for (std::size_t a = 0; a < D; ++a) {
      stiffness *= along[a][static_cast<std::size_t>(k[a])];
      k[a] -= B::before;
    }
    if (stiffness == 0.0) return;
    const int node = cell.first_node + patch.shape.distance(k);
    block.spring(spring_force_at, touch.axis)[node] += touch.inward() * stiffness * overlap;
    block.spring(spring_stiffness_at, touch.axis)[node] += stiffness;
    block.spring(spring_energy_at, touch.axis)[node] += 0.5 * stiffness * overlap * overlap;
  });
}

/// Add the springs of a patch's particles to its nodes.
template <int D>
void scatter_wall_springs(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
                          const Patch<D>& patch, const NodeBlock<D>& block) {
  if (!patch.at_wall) return;
  Bases::with(grid.basis, body.mean_edge / grid.cell_size, [&]<BasisModel B>(const B& basis) {
    for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k)
        for_each_wall_touch(grid, body, pool, cell.rows[k], [&](const WallTouch& touch) {
          add_wall_spring(basis, grid, body, pool, patch, block, cell, cell.rows[k], touch);
        });
    });
  });
}

/// What nodes beyond other walls have been given belongs to their images.
template <int D>
void fold_wall_springs(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block) {
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    for (int k = 0; k < wall_record; ++k) {
      double& given = block.springs[node][k];
      block.springs[image][k] += turned.component(given, k % half_record);
      given = 0.0;
    }
  });
}

/// A node that a wall's springs push, or at which its particles are stopped.
template <int D>
struct TouchedNode {
  Vec<double, D> F, K, E;  // of the springs along each axis [N], [N/m], [J]
  bool stopped;            // the wall stops approach: F and K only tell which faces are touched
  unsigned held;           // axes along which other walls hold it
  bool any = false;

  ContactSpring spring(int a) const { return {std::abs(F[a]), K[a], E[a]}; }
  /// From the body to the wall.
  double outward(int a) const { return side(a) == 0 ? -1.0 : 1.0; }
  int side(int a) const { return F[a] > 0.0 ? 0 : 1; }
  /// Is it held along the normal? Then it does not come nearer.
  bool stands(int a) const { return (held >> a & 1u) != 0; }
  /// Where the wall acts as springs along an axis, over a step.
  SolvedSpring over(int a, double dt) const {
    if (stopped) return {};
    const double approaches = stands(a) ? 0.0 : share_of_approach;
    return {dt * std::abs(F[a]), approaches * dt * dt * K[a], true};
  }
};

/// Take a node's springs from it: what they push with, or where it is stopped.
template <int D>
TouchedNode<D> take_springs(const Domain<D>& domain, const Patch<D>& patch,
                            const NodeBlock<D>& block, int node, bool stopped) {
  const Walls<D>& walls = domain.grid.walls;
  TouchedNode<D> touched;
  touched.stopped = stopped;
  for (int a = 0; a < D; ++a) {
    touched.F[a] = block.spring(spring_force_at, a)[node];
    touched.K[a] = block.spring(spring_stiffness_at, a)[node];
    touched.E[a] = block.spring(spring_energy_at, a)[node];
    touched.any = touched.any || touched.K[a] > 0.0;
  }
  clear(block.springs.from(node), 1, wall_record);
  touched.held = 0u;
  if (!touched.any) return touched;
  const Index<D> at = index_of(domain.grid, patch, node);
  touched.held = walls.constrained_axes(at);
  for (int a = 0; stopped && a < D; ++a)
    if (walls.depth_beyond(at, a, touched.side(a)) < 0) touched.K[a] = 0.0;
  return touched;
}

/// The body at a node against the walls, as it goes without them: a wall is a body that stands.
template <int D>
void start_solution(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block,
                    int node, const TouchedNode<D>& touched, NodeSolution<D>& solution) {
  const double dt = domain.time_step, drag = domain.damping_of(patch).half_drag(dt);
  const double m = block.mass()[node];
  const Vec<double, D> v = block.vector(node, velocity_at);
  Vec<double, D> alone =
      dt * (block.vector(node, force_at) + m * domain.gravity) - (2.0 * drag * m) * v;
  for (int a = 0; a < D; ++a)
    if (touched.held >> a & 1u) alone[a] = 0.0;
  solution.sides.resize(2);
  solution.sides[0] = {(1.0 + drag) * m, false, {}, {}};
  solution.sides[0].start(v, alone);
  solution.sides[1] = {std::numeric_limits<double>::infinity(), true, {}, {}};
  solution.sides[1].start(Vec<double, D>::zero(), Vec<double, D>::zero());
  solution.pairs.clear();
  for (int a = 0; a < D; ++a) {
    if (!(touched.K[a] > 0.0)) continue;
    Vec<double, D> normal = Vec<double, D>::zero();
    normal[a] = touched.outward(a);
    const double friction = domain.grid.walls.friction[a][touched.side(a)];
    solution.pairs.push_back({0, 1, true, false, friction, normal, touched.over(a, dt)});
  }
}

/// The walls' forces over a step on the nodes of a patch, with their friction, which are added to
/// the others; returns the energy that is stored in them after it, of the nodes it owns [J].
template <int D>
double push_from_walls(Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block) {
  // Grows to two bodies and D pairs once.
  thread_local NodeSolution<D> solution;
  const double dt = domain.time_step;
  // As against its own kind: liquids are stopped too, of which walls, that lie at nodes, take
  // little.
  const Matter matter = domain.body_of(patch).matter;
  const bool stopped = stops_approach(domain.contact_settings.response, matter, matter);
  double stored = 0.0;
  for (int n = 0; n < block.count; ++n) {
    const TouchedNode<D> touched = take_springs(domain, patch, block, n, stopped);
    if (!touched.any || !(block.mass()[n] > 0.0)) continue;
    start_solution(domain, patch, block, n, touched, solution);
    if (!solve_node<true>(solution))
      domain.contact.unconverged.fetch_add(1, std::memory_order_relaxed);
    const Vec<double, D> end = solution.sides[0].end_velocity();
    for (const SolvedPair<D>& pair : solution.pairs)
      for (int normal = 0; normal < D; ++normal) {
        if (pair.normal[normal] == 0.0) continue;
        for (int a = 0; a < D; ++a) {
          const double force =
              -(pair.normal_impulse * pair.normal[a] + pair.friction_impulse[a]) / dt;
          block.face_force(normal, a)[n] = force;
          block.force(a)[n] += force;
        }
        const double way = touched.stands(normal) ? 0.0 : dt * end[normal] * pair.normal[normal];
        if (patch.counts(n) && pair.spring.exists)
          stored += touched.spring(normal).energy_after(way);
      }
  }
  return stored;
}

/// The work of faces on the nodes that a patch owns, once these are advanced: that of the forces
/// along their normals, or of friction.
template <int D>
Work work_of_faces(const NodeBlock<D>& block, const double* own, double time_step,
                   bool along_normals) {
  Work work;
  if (block.springs.data == nullptr) return work;
  for (int normal = 0; normal < D; ++normal)
    for (int a = 0; a < D; ++a) {
      if ((a == normal) != along_normals) continue;
      for (int n = 0; n < block.count; ++n) {
        // As that of dashpots (absorb.hpp).
        const double f = own[n] * block.face_force(normal, a)[n], dv = block.increment(a)[n];
        work.first += f * (block.velocity(a)[n] - dv);
        work.second += f * dv;
      }
    }
  return {time_step * work.first, 0.5 * time_step * work.second};
}

}  // namespace mpm
