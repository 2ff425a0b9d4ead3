#pragma once
// Patches of other ranks beside a rank's own.
#include "mpm/grid/tile_grid.hpp"

namespace mpm {

/// Tell those who have tiles beside a patch which of its cells are occupied, and take in what they
/// tell; patches in tiles that belong to others now are dropped. True if patches came or went:
/// they are to be connected then. By all ranks at once.
template <int D>
bool exchange_patches(TileGrid<D>& grid);

}  // namespace mpm
