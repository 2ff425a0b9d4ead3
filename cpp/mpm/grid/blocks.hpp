#pragma once
// The nodal blocks: which nodes a patch has, and where they are in memory.
#include "mpm/grid/tile_grid.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {

/// Cut the blocks to the cells that hold particles, find the owners of shared nodes and the walls,
/// and make room for the nodes. Call when particles have changed cells.
template <int D>
void cut_blocks(TileGrid<D>& grid, Threads& threads);

/// Give the memory of the nodes back; they must be cut then.
template <int D>
void release_nodes(TileGrid<D>& grid) {
  grid.nodes.numbers.release_and_allocate(0);
  grid.kept.numbers.release_and_allocate(0);
  grid.shared.entries.release_and_allocate(0);
  grid.shared.used = 0;
}

}  // namespace mpm
