#pragma once
// Loads on surfaces: from the pieces that particles carry to the nodes, and the pieces along with
// the particles.
#include "mpm/domain.hpp"
#include "mpm/ledger/work.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"

namespace mpm {

/// Their work on a patch, with the velocities and increments of the nodes at the pieces.
template <int D>
Work work_of_loads(Domain<D>& domain, std::size_t patch);

/// f(row, piece) for the particles of a cell that carry a piece of a load.
template <int D, class F>
void for_each_piece(int load, ParticlePool<D>& pool, const CellRange<D>& cell, F&& f) {
  for (std::uint32_t k = 0; k < cell.count; ++k) {
    const std::uint32_t row = cell.rows[k];
    if (SurfacePiece<D>* piece = piece_of(pool.pieces, pool.piece[row], load)) f(row, *piece);
  }
}

/// Take the pieces of a patch's particles along; the nodal velocity that strains the material is
/// the vector at number `at` of the records, so that surface and material deform by the same L. One
/// by one and apart from the loop over all particles, as few of them carry a piece. `duration` [s]:
/// of the motion that they follow.
template <int at, int D>
[[gnu::noinline]] void carry_loads(Domain<D>& domain, std::size_t p, double duration) {
  const auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const Body<D>& body = domain.body_of(patch);
  ParticlePool<D>& pool = domain.pool_of(patch);
  const double scale = duration / grid.cell_size;
  for (int l = 0; l < static_cast<int>(domain.loads.size()); ++l) {
    // A piece per load: where two loads meet on a particle each carries its own along.
    if (domain.loads[static_cast<std::size_t>(l)].body != patch.body) continue;
    with_basis(grid, body, [&]<BasisModel B>(const B& basis) {
      const NodeStrides<D> stride(patch.shape);
      for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
        // With the linear basis a field is made for a whole cell, which few cells need.
        bool loaded = false;
        for_each_piece(l, pool, cell,
                       [&](std::uint32_t, const SurfacePiece<D>&) { loaded = true; });
        if (!loaded) return;
        const auto nodes = field_of<B>(domain.grid.block(p).records.from(cell.first_node), stride);
        for_each_piece(l, pool, cell, [&](std::uint32_t row, SurfacePiece<D>& piece) {
          Vec<double, D> xi;
          for (int a = 0; a < D; ++a)
            xi[a] = local_coordinate(grid.in_cells(pool.listed(a)[row], a), cell.cell[a]);
          const auto w = weights_at(basis, xi);
          const auto gradients = nodes.template gradients<at>(w);
          Mat<double, D> L;
          for (int i = 0; i < D; ++i)
            // L dt: gradients are with respect to xi, in cells.
            for (int j = 0; j < D; ++j) L[i][j] = scale * gradients[static_cast<std::size_t>(i)][j];
          piece.carry(L);
        });
      });
    });
  }
}

}  // namespace mpm
