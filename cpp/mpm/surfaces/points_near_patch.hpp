#pragma once
// Which contact points the particles of a patch may feel that lie in space.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include "mpm/domain.hpp"
#include "mpm/surfaces/felt.hpp"

namespace mpm {

/// How far off a point may be felt [m].
template <int D>
double pressed_within(const Surfaces<D>& surfaces) {
  return SurfacePoint<D>::reach * surfaces.spacing;
}

/// How far the particles of a patch are out of the cells in whose lists they stand, at most: they
/// have moved since these were made [m].
template <int D>
double beyond_cells(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch) {
  const Index<D> first = grid.first_cell(patch.tile);
  double most = 0.0;
  patch.for_each_cell([&](int cell, std::uint32_t begin, std::uint32_t end) {
    const Index<D> local = Tile<D>::cell_index(cell);
    for (std::uint32_t k = begin; k < end; ++k)
      for (int a = 0; a < D; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const double xi = grid.in_cells(pool.x(a)[pool.order[k]], a) - (first[axis] + local[axis]);
        most = std::max({most, -xi, xi - 1.0});
      }
  });
  return grid.cell_size * most;
}

/// The points that may be felt from the cells of a patch, cell by cell.
template <int D>
class PointsNear {
 public:
  /// Returns whether there are any.
  bool find(const Domain<D>& domain, const Patch<D>& patch) {
    const Surfaces<D>& surfaces = domain.surfaces;
    const TileGrid<D>& grid = domain.grid;
    near_.clear();
    for (auto& cell : cells_) cell.clear();
    const Index<D> first = grid.first_cell(patch.tile);
    for (int k = 0; k < Tile<D>::neighbours; ++k)
      for (auto [at, end] =
               std::ranges::equal_range(surfaces.by_tile, Tile<D>::beside(patch.tile, k),
                                        tile_less<D>, &PointInTile<D>::tile);
           at != end; ++at)
        near_.push_back(*at);
    std::ranges::sort(near_, {}, [](const PointInTile<D>& one) {
      return std::tuple(one.body, one.face, one.point);
    });
    if (near_.empty()) return false;
    const double reach =
        pressed_within(surfaces) + beyond_cells(grid, domain.pool_of(patch), patch);
    bool any = false;
    for (const PointInTile<D>& one : near_) {
      const Vec<double, D>& place = surfaces.places[one.point];
      Index<D> low, high;
      bool inside = true;
      for (std::size_t a = 0; a < D; ++a) {
        const int axis = static_cast<int>(a);
        const auto cell = [&](double x) {
          return static_cast<int>(std::floor(grid.in_cells(x, axis))) - first[a];
        };
        low[a] = std::max(cell(place[axis] - reach), 0);
        high[a] = std::min(cell(place[axis] + reach), Tile<D>::cells - 1);
        inside = inside && low[a] <= high[a];
      }
      if (!inside) continue;
      for_each_index<D>(low, high, [&](const Index<D>& cell) {
        const int c = Tile<D>::cell(cell);
        if ((patch.occupied >> c & 1u) == 0) return;
        cells_[static_cast<std::size_t>(c)].push_back(one);
        any = true;
      });
    }
    return any;
  }
  /// By body and face.
  std::span<const PointInTile<D>> of(int cell) const {
    return cells_[static_cast<std::size_t>(cell)];
  }

 private:
  std::vector<PointInTile<D>> near_;
  std::array<std::vector<PointInTile<D>>, Tile<D>::cell_count> cells_;
};

}  // namespace mpm
