#pragma once
// Which patches there are, and which are neighbours.
#include "mpm/grid/tile_grid.hpp"

namespace mpm {

/// Find neighbours, of bonded bodies by the patch that leads in its tile. Call when patches were
/// added or removed, or others lead; there are no blocks then until they have been cut.
template <int D>
void connect(TileGrid<D>& grid);

/// Do the patches that lead in their tiles still have particles there?
template <int D>
bool leaders_are_known(const TileGrid<D>& grid);

/// The patch of a body in a tile, or -1.
template <int D>
int find_patch(const TileGrid<D>& grid, int body, const Index<D>& tile);

}  // namespace mpm
