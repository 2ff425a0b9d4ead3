#pragma once
// The two loops every particle stage is made of: over the cells of a patch, and over a cell's
// particles in lanes.
#include <bit>

#include "mpm/fields/lanes.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/particles/pool.hpp"

namespace mpm {

/// A cell of a patch being worked on: its coordinates, its first node in the block, its particles.
template <int D>
struct CellRange {
  Index<D> cell;   // grid coordinates
  int first_node;  // its own, in the patch's block: in its lower corner, with GIMP in its middle
  const std::uint32_t* rows;
  std::uint32_t count;
};

/// f(CellRange) for every occupied cell of a patch.
/// The lowest bit of `occupied` first, so x fastest: with the order of the numbers within a cell
/// this is the order of all sums over a patch, whatever thread takes it (decision 0033).
template <int D, class F>
void for_each_cell(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch,
                   F&& f) {
  const Index<D> first = grid.first_cell(patch.tile);
  patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
    const Index<D> local = Tile<D>::cell_index(c);
    CellRange<D> range{first, patch.shape.node(local), pool.order.data() + begin, end - begin};
    for (std::size_t a = 0; a < D; ++a) range.cell[a] += local[a];
    f(range);
  });
}

/// f(rows) for the particles of a cell, a few at a time: LaneRows or WholeRows.
template <int lanes, int D, class F>
[[gnu::always_inline]] inline void for_each_group(const CellRange<D>& cell, F&& f) {
  for_each_lanes<lanes>(cell.rows, cell.count, f);
}

/// Position of particles in their cell, in [0, 1]. A copy of what it takes of the grid, so that it
/// stays in registers.
template <int D>
class LocalPosition {
 public:
  LocalPosition(const TileGrid<D>& grid, const ParticlePool<D>& pool) : cells_(grid.coordinates()) {
    for (int a = 0; a < D; ++a) x_[a] = pool.listed(a);
  }
  template <class Rows>
  auto operator()(const CellRange<D>& cell, const Rows& rows) const {
    // Held 1e-12 off the faces (local_coordinate): on a face the far node has N = 0 but a gradient,
    // so that it would get force and no mass. Loop over axes written out: xi stays in registers.
    Vec<Batch<Rows::lanes>, D> xi;
    unrolled<D>([&](auto a) {
      xi[a] = local_coordinate(cells_.in_cells(load(x_[a], rows), a), cell.cell[a]);
    });
    return xi;
  }

 private:
  CellCoordinates<D> cells_;
  const double* x_[D];
};

/// f(basis) for the basis of the grid and the size of a body's particles.
/// The edge is that of the start, for uniform GIMP; a constant of the body, so that one choice
/// serves all of a patch.
template <int D, class F>
void with_basis(const TileGrid<D>& grid, const Body<D>& body, F&& f) {
  Bases::with(grid.basis, body.mean_edge / grid.cell_size, std::forward<F>(f));
}

/// f(basis, lanes): the same, and how many of a patch's particles are taken at a time.
template <int D, class F>
void with_basis_and_lanes(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch,
                          F&& f) {
  with_basis(grid, body, [&](const auto& basis) {
    // Half registers where cells hold at most four on average (AVX-512 in 3D): half of the empty
    // lanes go. Chosen for a patch and not for each cell, as that cost full cells 3 to 5 %
    // (decision 0026). Count and cells are the case's, so the ledger's sums over lanes keep their
    // order.
    constexpr int all = cell_lanes<D>, few = few_lanes<D>;
    if constexpr (few < all) {
      const auto occupied = static_cast<std::uint32_t>(std::popcount(patch.occupied));
      if (patch.count <= few * occupied) {
        f(basis, std::integral_constant<int, few>{});
        return;
      }
    }
    f(basis, std::integral_constant<int, all>{});
  });
}

}  // namespace mpm
