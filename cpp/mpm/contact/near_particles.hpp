#pragma once
// The particles of a body around a node: what normals and gaps are made of.
#include <limits>
#include <vector>

#include "mpm/fields/lanes.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/particles/body.hpp"

namespace mpm {

/// f(place, xi, rows) for the particles, in lanes, of the cells of a patch from which a node is in
/// reach; `place` is the node's coordinate in the cell (0 or 1 at its corners) and xi the position
/// in it.
template <int D, class F>
void for_particles_around(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch,
                          int node, F&& f) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  const int margin = grid.shape.margin, width = 2 + 2 * margin;
  const Index<D> at = grid.shape.index(node);
  const Index<D> first = grid.first_cell(patch.tile);
  for (int k = power(width, D) - 1; k >= 0; --k) {
    Index<D> cell, place;
    bool inside = true;
    for (int a = 0, left = k; a < D; ++a, left /= width) {
      place[a] = left % width - margin;
      cell[a] = at[a] - place[a];
      inside = inside && cell[a] >= 0 && cell[a] < Tile<D>::cells;
    }
    if (!inside) continue;
    const auto c = static_cast<std::size_t>(Tile<D>::cell(cell));
    const std::uint32_t end = patch.cell_begin[c + 1];
    for (std::uint32_t i = patch.cell_begin[c]; i < end; i += W) {
      const LaneRows<W> rows(body.order.data() + patch.begin + i, end - i);
      Vec<T, D> xi;
      for (int a = 0; a < D; ++a)
        xi[a] = local_coordinate(grid.in_cells(load(body.x(a), rows), a), first[a] + cell[a]);
      f(place, xi, rows);
    }
  }
}

/// Edge length of a particle from its volume: the square root in 2D (unit thickness), the cube root
/// in 3D by Halley's iteration from the body's mean, to 1e-6 for volumes within a factor of ten of
/// it.
template <int D, class T>
T particle_edge(T volume, double mean_edge) {
  if constexpr (D == 2) {
    return sqrt(volume);
  } else {
    const T ratio = volume * T(1.0 / (mean_edge * mean_edge * mean_edge));
    T y(1.0);
    for (int k = 0; k < 3; ++k) {
      const T cube = y * y * y;
      y = y * (cube + T(2.0) * ratio) / (T(2.0) * cube + ratio);
    }
    return T(mean_edge) * y;
  }
}

/// The particles of a body from which a node is in reach, in lanes. Empty places in the lanes
/// repeat a particle of the body and have no weight.
template <int D>
struct NearParticles {
  using T = Batch<native_lanes>;
  struct Lanes {
    Vec<T, D> x;  // position from the node [cells]
    T half;       // half the particle's edge [cells]; -infinity for one out of reach
    T weight;     // mass [kg]; 0 for one out of reach
  };
  std::vector<Lanes> lanes;
  T mass = T(0.0);                       // of all, by lane [kg]
  Vec<T, D> moment = Vec<T, D>::zero();  // the same times x

  /// Forget all, with room for 8 lanes in each cell from which a node is in reach, so that steps
  /// seldom allocate.
  void clear(int margin) {
    lanes.clear();
    mass = T(0.0);
    moment = Vec<T, D>::zero();
    lanes.reserve(8 * static_cast<std::size_t>(power(2 + 2 * margin, D)));
  }

  void add(const Lanes& p) {
    mass += p.weight;
    for (int a = 0; a < D; ++a) moment[a] += p.weight * p.x[a];
    lanes.push_back(p);
  }

  /// Mass in reach [kg] and its centre from the node [cells]; zero without mass.
  double total() const { return sum(mass); }
  Vec<double, D> centre() const {
    const double all = total();
    Vec<double, D> c = Vec<double, D>::zero();
    if (!(all > 0.0)) return c;
    for (int a = 0; a < D; ++a) c[a] = sum(moment[a]) / all;
    return c;
  }

  /// How far the body extends from the node along a unit vector: max of x . n + l [cells], eq. (5),
  /// with l half the edge of a cube of the particle's present volume; -infinity if there are no
  /// particles. Those within a cell of the line through the node along n count: beside the
  /// place where round bodies touch, their surfaces are still apart. If the line misses the body,
  /// as beside an edge, all count.
  double extent_along(const Vec<double, D>& normal) const {
    constexpr double radius = 1.0;
    T on_line(-std::numeric_limits<double>::infinity()), anywhere = on_line;
    for (const Lanes& p : lanes) {
      T along(0.0), square(0.0);
      for (int a = 0; a < D; ++a) {
        along += T(normal[a]) * p.x[a];
        square += p.x[a] * p.x[a];
      }
      const T distance = along + p.half;
      anywhere = max(anywhere, distance);
      on_line =
          select(square - along * along < T(radius * radius), max(on_line, distance), on_line);
    }
    const double there = largest(on_line);
    return there > -std::numeric_limits<double>::infinity() ? there : largest(anywhere);
  }
};

/// Add the particles of a patch from which one of its nodes is in reach.
template <int D>
void collect_near(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch, int node,
                  NearParticles<D>& to) {
  using T = Batch<native_lanes>;
  // Over this length [cells] a particle's weight falls to 0 where its reach ends: particles on a
  // lattice lie there in whole rows, and rounding must not choose among them.
  constexpr double rim = 1e-3;
  const double reach = support(grid.basis, body.mean_edge / grid.cell_size);
  for_particles_around(
      grid, body, patch, node, [&](const Index<D>& place, const Vec<T, D>& xi, const auto& rows) {
        typename NearParticles<D>::Lanes p;
        p.weight = select(first_lanes<native_lanes>(rows.count), load(body.mass(), rows), T(0.0));
        auto near = T(0.0) < T(1.0);
        for (int a = 0; a < D; ++a) {
          p.x[a] = xi[a] - T(place[a]);
          const T to_rim = T(reach) - max(p.x[a], -p.x[a]);
          near = near & (to_rim > T(0.0));
          p.weight *= min(max(T(1.0 / rim) * to_rim, T(0.0)), T(1.0));
        }
        if (!any(near)) return;
        const T edge_now = particle_edge<D>(load(body.volume(), rows), body.mean_edge);
        p.half = select(near, T(0.5 / grid.cell_size) * edge_now,
                        T(-std::numeric_limits<double>::infinity()));
        to.add(p);
      });
}

}  // namespace mpm
