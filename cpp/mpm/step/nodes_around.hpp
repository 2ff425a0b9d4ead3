#pragma once
// The nodes between which a particle lies, for what has linear functions: walls that absorb with
// every basis, loads on surfaces where it is not the B-splines.
#include "mpm/domain.hpp"
#include "mpm/schedule/cell_loop.hpp"

namespace mpm {

/// The nodes at the corners of the square or cube of the grid that a particle is in, which is
/// not its cell where that is centred at a node.
template <int D>
struct NodesAround {
  double place[D];  // position among the nodes
  Index<D> lower;   // the node at the lower corner
  int first;        // its number in the patch's block

  NodesAround(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch,
              const CellRange<D>& cell, std::uint32_t row) {
    Index<D> from_cell;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      // A cell that is centred at its own node reaches half a cell to both sides of it: before it,
      // the node below is the lower corner.
      place[a] = grid.among_nodes(pool.listed(a)[row], a);
      const bool before = grid.reach().own_node > 0.0 && place[a] < cell.cell[k];
      lower[k] = cell.cell[k] - (before ? 1 : 0);
      from_cell[k] = lower[k] - cell.cell[k];
    }
    // In the block, as this holds a node on either side where cells are centred (BlockShape).
    first = cell.first_node + patch.shape.distance(from_cell);
  }
};

}  // namespace mpm
