#pragma once
// A body's surface as seen from a node: outward normal from the gradient of mass, and how far the body reaches.
#include "mpm/basis/linear.hpp"
#include "mpm/contact/contact_grid.hpp"
#include "mpm/fields/lanes.hpp"

namespace mpm {

/// Does a holder's patch have this node (numbered from the tile's first) in its block?
template <int D>
bool holds_node(const TileHolder& holder, const Index<D>& node) {
  for (int a = 0; a < D; ++a)
    if ((holder.corner >> a & 1) && node[a] != 0) return false;
  return true;
}
/// The node's number in the holder's block.
template <int D>
int node_in_holder(const TileHolder& holder, Index<D> node) {
  for (int a = 0; a < D; ++a)
    if (holder.corner >> a & 1) node[a] += Tile<D>::cells;
  return Tile<D>::node(node);
}

/// f(node) for the nodes that belong to a tile: all but those at its upper ends, which are the next tile's first.
template <int D, class F>
void for_each_tile_node(F&& f) {
  for (int c = 0; c < Tile<D>::cell_count; ++c) f(Tile<D>::cell_index(c));
}

/// f(corner, xi, rows) for the particles, in lanes, of the cells of a patch around a node; `corner` is the node's place
/// in the cell and xi the position in it.
template <int D, class F>
void for_particles_around(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch, int node, F&& f) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  const Index<D> at = Tile<D>::node_index(node);
  const Index<D> first = grid.first_cell(patch.tile);
  for (int k = Tile<D>::corners - 1; k >= 0; --k) {
    const Index<D> corner = Tile<D>::corner(k);
    Index<D> cell;
    bool inside = true;
    for (int a = 0; a < D; ++a) {
      cell[a] = at[a] - corner[a];
      inside = inside && cell[a] >= 0 && cell[a] < Tile<D>::cells;
    }
    if (!inside) continue;
    const auto c = static_cast<std::size_t>(Tile<D>::cell(cell));
    const std::uint32_t end = patch.cell_begin[c + 1];
    for (std::uint32_t i = patch.cell_begin[c]; i < end; i += W) {
      const LaneRows<W> rows(body.order.data() + patch.begin + i, end - i);
      Vec<T, D> xi;
      for (int a = 0; a < D; ++a)
        xi[a] = Linear<D>::local(grid.in_cells(load(body.x(a), rows), a), first[a] + cell[a]);
      f(corner, xi, rows);
    }
  }
}

/// Sum of m_p grad N_ip [kg/m] over the particles of a patch around one of its nodes; it points out of the body.
template <int D>
Vec<double, D> mass_gradient(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch, int node) {
  using T = Batch<native_lanes>;
  Vec<T, D> total = Vec<T, D>::zero();
  for_particles_around(grid, body, patch, node, [&](const Index<D>& corner, const Vec<T, D>& xi, const auto& rows) {
    const T mass = select(first_lanes<native_lanes>(rows.count), load(body.mass(), rows), T(0.0));
    for (int a = 0; a < D; ++a) {
      T g = corner[a] ? mass : -mass;
      for (int b = 0; b < D; ++b)
        if (b != a) g = g * (corner[b] ? xi[b] : T(1.0) - xi[b]);
      total[a] += g;
    }
  });
  Vec<double, D> r;
  for (int a = 0; a < D; ++a) r[a] = sum(total[a]) / grid.cell_size;
  return r;
}

/// Edge length of a particle from its volume: the square root in 2D (unit thickness), the cube root in 3D by Halley's
/// iteration from the body's mean, to 1e-6 for volumes within a factor of ten of it.
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

/// max over the particles of a patch near a node of (x_p - x_i) . n + l_p [m], eq. (5), with l_p half the edge of a cube
/// of the particle's present volume; -infinity if there are none.
template <int D>
double surface_distance(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch, int node,
                        const Vec<double, D>& normal) {
  using T = Batch<native_lanes>;
  T furthest(-std::numeric_limits<double>::infinity());
  for_particles_around(grid, body, patch, node, [&](const Index<D>& corner, const Vec<T, D>& xi, const auto& rows) {
    // Lanes past the end repeat the last particle, which changes no maximum.
    T distance = T(0.5) * particle_edge<D>(load(body.volume(), rows), body.mean_edge);
    for (int a = 0; a < D; ++a) distance += T(normal[a] * grid.cell_size) * (xi[a] - T(corner[a]));
    furthest = max(furthest, distance);
  });
  return largest(furthest);
}

/// The unit normal from body r to body s of a pair from the bodies' own outward normals; zero if they do not oppose.
template <int D>
Vec<double, D> pair_normal(const Vec<double, D>& r, const Vec<double, D>& s, NormalRule rule, bool r_is_stiffer) {
  if (rule == NormalRule::first || (rule == NormalRule::stiffer && r_is_stiffer)) return r;
  if (rule == NormalRule::second || rule == NormalRule::stiffer) return -1.0 * s;
  constexpr double parallel = 1e-6;  // normals that differ by less give no direction
  return normalised(r - s, parallel);
}

}  // namespace mpm
