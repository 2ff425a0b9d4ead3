#pragma once
// Which patches there are, and which are neighbours.
#include "mpm/grid/tile_grid.hpp"

namespace mpm {

/// Find neighbours. Call when patches were added or removed; there are no blocks then until they
/// have been cut.
template <int D>
void connect(TileGrid<D>& grid);

/// The patch of a body in a tile, or -1.
template <int D>
int find_patch(const TileGrid<D>& grid, int body, const Index<D>& tile);

}  // namespace mpm
