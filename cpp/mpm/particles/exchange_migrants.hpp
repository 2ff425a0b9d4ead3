#pragma once
#include "mpm/particles/cell_lists.hpp"

namespace mpm {

/// Send migrants that have come into tiles of other ranks there, and take in those that come from
/// others, as migrants to tiles of this rank. By all ranks at once.
template <int D>
void exchange_migrants(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, ListScratch<D>& scratch);

}  // namespace mpm
