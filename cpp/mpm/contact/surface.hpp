#pragma once
// A body as seen from a node: its particles around it and its outward normal from the gradient of
// mass.
#include <algorithm>
#include <span>

#include "mpm/basis/basis.hpp"
#include "mpm/contact/contact_grid.hpp"
#include "mpm/fields/lanes.hpp"

namespace mpm {

/// Does a block reach any node that belongs to neighbour k?
template <int D>
bool reaches(const BlockShape<D>& shape, int k) {
  bool any = true;
  const Index<D> o = Tile<D>::offset(k);
  for (int a = 0; a < D; ++a) any = any && (o[a] >= 0 || shape.margin > 0);
  return any;
}

/// f(node) for the nodes that belong to a tile: all but those at its upper ends, which are the next
/// tile's first.
template <int D, class F>
void for_each_tile_node(F&& f) {
  for (int c = 0; c < Tile<D>::cell_count; ++c) f(Tile<D>::cell_index(c));
}

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

/// Sum of m_p grad N_ip [kg/m] over the particles of a patch around one of its nodes; it points out
/// of the body.
template <int D>
Vec<double, D> mass_gradient(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch,
                             int node) {
  using T = Batch<native_lanes>;
  Vec<T, D> total = Vec<T, D>::zero();
  with_basis(grid.basis, grid.shape, body.mean_edge / grid.cell_size, [&](const auto& basis) {
    for_particles_around(
        grid, body, patch, node, [&](const Index<D>& place, const Vec<T, D>& xi, const auto& rows) {
          const T mass =
              select(first_lanes<native_lanes>(rows.count), load(body.mass(), rows), T(0.0));
          for (int a = 0; a < D; ++a) {
            T g = mass;
            for (int b = 0; b < D; ++b)
              g = g * (b == a ? basis.slope(place[b], xi[b]) : basis.factor(place[b], xi[b]));
            total[a] += g;
          }
        });
  });
  Vec<double, D> r;
  for (int a = 0; a < D; ++a) r[a] = sum(total[a]) / grid.cell_size;
  return r;
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

/// The outward unit normal of a body at a node, times min(1, |gradient| h / mass): one where the
/// body ends at the node, near zero where the body surrounds it and the direction of its gradient
/// is chance.
template <int D>
Vec<double, D> weighted_normal(const Vec<double, D>& gradient, double mass, double cell_size) {
  const double length = norm(gradient);
  return length > 0.0 ? (std::min(1.0, length * cell_size / mass) / length) * gradient
                      : Vec<double, D>::zero();
}

/// The unit normal from body r to body s of a pair by a rule on the normals of the two; zero if
/// there is none.
template <int D>
Vec<double, D> pair_normal(const Side<D>& r, const Side<D>& s, NormalRule rule,
                           const std::vector<double>& stiffness) {
  constexpr double parallel = 1e-6;  // normals that differ by less give no direction
  if (rule == NormalRule::pair) return normalised(r.normal - s.normal, parallel);
  const auto stiff = [&](const Side<D>& x) { return stiffness[static_cast<std::size_t>(x.body)]; };
  const bool r_is_first = r.body < s.body;
  const bool r_is_stiffer = stiff(r) != stiff(s) ? stiff(r) > stiff(s) : r_is_first;
  const bool takes_r = rule == NormalRule::first    ? r_is_first
                       : rule == NormalRule::second ? !r_is_first
                                                    : r_is_stiffer;
  return normalised(takes_r ? r.normal : -1.0 * s.normal);
}

/// Put the bodies at a node into an order that does not depend on how bodies are numbered, as far
/// as masses and velocities tell them apart: the solution for several bodies with friction is not
/// unique, and the order of its steps chooses.
template <int D>
void sort_sides(std::span<Side<D>> sides) {
  std::sort(sides.begin(), sides.end(), [](const Side<D>& x, const Side<D>& y) {
    if (x.mass != y.mass) return x.mass > y.mass;
    for (int a = 0; a < D; ++a)
      if (x.mapped[a] != y.mapped[a]) return x.mapped[a] > y.mapped[a];
    return x.body < y.body;
  });
}

}  // namespace mpm
