#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Find the tiles where bodies may meet, one of them deforming, and mark the patches that may have
/// nodes there. Call when patches were added or removed.
template <int D>
void connect_tiles(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                   Response response);

}  // namespace mpm
