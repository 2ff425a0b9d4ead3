#pragma once
// Walls that push back what touches them and let it part, with friction. A particle overlaps the
// plane of a face by o_p = l_p - b_p - z_p: half its edge, less what its surface is set back, less
// the height of its centre. It is pushed along the normal by a spring as bodies are by rigid ones
// (decision 0054), of the stiffness k_p = rho c^2 A_p / e_p, the edge's area over its length, at
// the middle of the overlap. At a node the springs come to
//   F_i = sum_p N_i k_p o_p, K_i = sum_p N_i k_p,
// and over a step to the force in its middle with the approach u at its end, F_i + K_i u dt / 2;
// friction takes up to mu of that (eqs. 14-15), no more than what brings the node to rest.
#include "mpm/contact/contact_node.hpp"
#include "mpm/contact/node_solver.hpp"
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
  using T = Batch<contact_lanes>;
  for (int axis = 0; axis < D; ++axis)
    for (const int side : {0, 1}) {
      if (grid.walls.face[axis][side] != Wall::contact) continue;
      const double x = grid.among_nodes(pool.x(axis)[row], axis);
      const double height = side == 0 ? x : grid.walls.cells[static_cast<std::size_t>(axis)] - x;
      if (height > 1.0) continue;  // beyond all edges that go with the grid
      const double half =
          0.5 / grid.cell_size * particle_edge<D>(T(double{pool.volume()[row]}), body.mean_edge)[0];
      const double back = pool.set_back < 0 ? 0.0 : pool.columns.component(pool.set_back)[row];
      const double overlap = half * (1.0 - back) - height;
      if (overlap > 0.0) f(WallTouch{axis, side, overlap, half});
    }
}

/// Shares of a point's force for the nodes along an axis that a particle's cell reaches.
template <BasisModel B>
struct SharesAlong {
  double of[B::nodes];

  /// Those of the particle's own functions at x from the cell's own node [cells].
  SharesAlong(const B& basis, double x) {
    for (int k = 0; k < B::nodes; ++k) of[k] = shape_along(basis, x - (k - B::before));
  }
  /// Those of a point at `place`, of nodes that the particle at x reaches; what others would have
  /// is given to the node of the face, `face` from the cell's own.
  SharesAlong(const B& basis, double x, double place, int face) : SharesAlong(basis, x) {
    int nearest = 0;
    double rest = 1.0;
    for (int k = 0; k < B::nodes; ++k) {
      const bool reached = of[k] > 0.0;
      if (std::abs(k - B::before - face) < std::abs(nearest - B::before - face) && reached)
        nearest = k;
      of[k] = reached ? shape_along(basis, place - (k - B::before)) : 0.0;
      rest -= of[k];
    }
    of[nearest] += rest;
  }
};

/// Add the springs of a patch's particles to its nodes.
template <int D>
void scatter_wall_springs(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
                          const Patch<D>& patch, const NodeBlock<D>& block) {
  if (!patch.at_wall) return;
  const double h = grid.cell_size;
  Bases::with(grid.basis, body.mean_edge / h, [&]<BasisModel B>(const B& basis) {
    const auto of_row = [&](const CellRange<D>& cell, std::uint32_t row, const WallTouch& touch) {
      const auto axis = static_cast<std::size_t>(touch.axis);
      const auto from_cell = [&](int a) {
        return grid.among_nodes(pool.x(a)[row], a) - cell.cell[static_cast<std::size_t>(a)];
      };
      const int face = (touch.side == 0 ? 0 : grid.walls.cells[axis]) - cell.cell[axis];
      const double place = face - touch.inward() * 0.5 * touch.overlap;
      const double edge = 2.0 * touch.half * h, overlap = touch.overlap * h;
      const double stiffness = body.stiffness * std::pow(edge, D - 2);
      std::array<std::optional<SharesAlong<B>>, D> along;
      for (std::size_t a = 0; a < D; ++a) {
        const double x = from_cell(static_cast<int>(a));
        if (a == axis)
          along[a].emplace(basis, x, place, face);
        else
          along[a].emplace(basis, x);
      }
      Index<D> low{}, high;
      high.fill(B::nodes - 1);
      for_each_index<D>(low, high, [&](Index<D> k) {
        double share = stiffness;
        for (std::size_t a = 0; a < D; ++a) {
          share *= along[a]->of[k[a]];
          k[a] -= B::before;
        }
        if (share == 0.0) return;
        const int node = cell.first_node + patch.shape.distance(k);
        block.spring_force(touch.axis)[node] += touch.inward() * share * overlap;
        block.spring_stiffness(touch.axis)[node] += share;
        block.spring_energy(touch.axis)[node] += 0.5 * share * overlap * overlap;
      });
    };
    for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k)
        for_each_wall_touch(grid, body, pool, cell.rows[k],
                            [&](const WallTouch& touch) { of_row(cell, cell.rows[k], touch); });
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

/// The springs' forces over a step on the nodes of a patch, with their friction, which are added to
/// the others; returns the energy that is stored in them after it, of the nodes it owns [J].
template <int D>
double push_from_walls(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block) {
  const TileGrid<D>& grid = domain.grid;
  const double dt = domain.time_step, drag = domain.damping_of(patch).half_drag(dt);
  thread_local NodeSolution<D> solution;
  solution.sides.resize(2);
  double stored = 0.0;
  for (int n = 0; n < block.count; ++n) {
    double& m = block.mass()[n];
    Vec<double, D> F, K, E;
    bool any = false;
    for (int a = 0; a < D; ++a) {
      F[a] = std::exchange(block.spring_force(a)[n], 0.0);
      K[a] = std::exchange(block.spring_stiffness(a)[n], 0.0);
      E[a] = block.spring_energy(a)[n];
      any = any || K[a] > 0.0;
    }
    if (!any || !(m > 0.0)) continue;
    const Index<D> index = index_of(grid, patch, n);
    const unsigned held = grid.walls.constrained_axes(index);
    const Vec<double, D> v = block.vector(n, velocity_at);
    Vec<double, D> alone =
        dt * (block.vector(n, force_at) + m * domain.gravity) - 2.0 * drag * m * v;
    for (int a = 0; a < D; ++a)
      if (held >> a & 1u) alone[a] = 0.0;
    solution.sides[0] = {(1.0 + drag) * m, false, {}, {}};
    solution.sides[0].start(v, alone);
    solution.sides[1] = {std::numeric_limits<double>::infinity(), true, {}, {}};
    solution.sides[1].start(Vec<double, D>::zero(), Vec<double, D>::zero());
    solution.pairs.clear();
    for (int a = 0; a < D; ++a) {
      if (!(K[a] > 0.0)) continue;
      Vec<double, D> normal = Vec<double, D>::zero();  // from the body to the wall
      normal[a] = F[a] > 0.0 ? -1.0 : 1.0;
      solution.pairs.push_back({0,
                                1,
                                true,
                                false,
                                grid.walls.friction[a][F[a] > 0.0 ? 0 : 1],
                                normal,
                                {dt * std::abs(F[a]), 0.5 * dt * dt * K[a], true}});
    }
    solve_node<true>(solution);
    const Vec<double, D> end = solution.sides[0].end_velocity();
    for (const SolvedPair<D>& pair : solution.pairs) {
      const double own = patch.counts(n) ? 1.0 : 0.0;
      for (int a = 0; a < D; ++a) {
        const double push = -pair.normal_impulse * pair.normal[a] / dt,
                     friction = -pair.friction_impulse[a] / dt;
        block.push(a)[n] += push;
        block.friction(a)[n] += friction;
        block.force(a)[n] += push + friction;
        if (pair.normal[a] != 0.0)
          stored += own * ContactSpring{std::abs(F[a]), K[a], E[a]}.energy_after(dt * end[a] *
                                                                                 pair.normal[a]);
      }
    }
  }
  return stored;
}

}  // namespace mpm
