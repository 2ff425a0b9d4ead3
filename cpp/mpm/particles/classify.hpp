#pragma once
// Where a patch's particles are now: in which cell of its tile, outside, or gone.
#include <bit>

#include "mpm/fields/lanes.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/particles/pool.hpp"

namespace mpm {

/// In place of the number of a cell.
struct CellMark {
  static constexpr std::uint8_t outside = 255;  // the particle has left its tile
  static constexpr std::uint8_t eroded = 254;   // it takes no part any more: failed
  static constexpr std::uint8_t left = 253;     // the same: out of the region that is kept
};

/// The cells of particles by their numbers in a tile, whose first cell is `first`, or
/// CellMark::outside.
template <int D, int W>
Batch<W> cells_in_tile(const CellCoordinates<D>& cells, const Index<D>& first,
                       const Vec<Batch<W>, D>& x) {
  using T = Batch<W>;
  T number(0.0);
  auto inside = T(0.0) < T(1.0);
  for (int a = D - 1; a >= 0; --a) {
    // The expression of GridGeometry::cell_of, in lanes: one that rounds otherwise would leave
    // particles in cells that they are not in.
    const T local = floor(cells.in_cells(x[a], a)) - T(first[static_cast<std::size_t>(a)]);
    inside = inside & (local >= T(0.0)) & (local < T(Tile<D>::cells));
    number = number * T(Tile<D>::cells) + local;
  }
  return select(inside, number, T(CellMark::outside));
}

/// Note the cell of each particle of a patch, by its place in the patch's list, or that it is
/// outside; returns how many have changed cell.
template <int D>
std::size_t note_cells(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch,
                       std::uint8_t* marks) {
  constexpr int W = native_lanes;
  const Index<D> first = grid.first_cell(patch.tile);
  const CellCoordinates<D> coordinates = grid.coordinates();
  std::size_t changed = 0;
  patch.for_each_cell([&](int old_cell, std::uint32_t begin, std::uint32_t end) {
    std::uint8_t* to = marks + (begin - patch.begin);
    for_each_lanes<W>(pool.order.data() + begin, end - begin, [&](const auto& rows) {
      Vec<Batch<W>, D> x;
      for (int a = 0; a < D; ++a) x[a] = load(pool.listed(a), rows);
      const Batch<W> now = cells_in_tile<D>(coordinates, first, x), old(old_cell);
      for (int k = 0; k < rows.count; ++k) *to++ = static_cast<std::uint8_t>(now[k]);
      // Empty lanes repeat a particle, which must not count twice.
      const auto others = ((now < old) | (now > old)) & first_lanes<W>(rows.count);
      changed += static_cast<std::size_t>(std::popcount(lane_bits(others)));
    });
  });
  return changed;
}

/// Of those, which have failed for good or are out of the region that is kept; a rigid body leaves
/// it as a whole. Returns how many of them had not changed cell.
template <int D>
std::size_t note_removed(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
                         const Patch<D>& patch, std::uint8_t* marks) {
  const double* failed = pool.at.failed >= 0 ? pool.columns.component(pool.at.failed) : nullptr;
  if (!failed && !grid.outflow_box.exist) return 0;
  const auto stays = [&](std::uint32_t row) {
    if (!body.deforms()) return !body.leaves;
    return !grid.outflow_box.exist || grid.outflow_box.holds(pool.position_of(row));
  };
  std::size_t more = 0;
  patch.for_each_cell([&](int old_cell, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t row = pool.order[k];
      const bool erodes = failed && failed[row] >= static_cast<double>(FailureAction::erode);
      if (!erodes && stays(row)) continue;
      std::uint8_t& mark = marks[k - patch.begin];
      more += mark == old_cell;
      mark = erodes ? CellMark::eroded : CellMark::left;
    }
  });
  return more;
}

}  // namespace mpm
