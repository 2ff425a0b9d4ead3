#pragma once
// What ranks tell each other of contact: a tile's contacts are found and solved by the rank that
// has the tile.
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Tell those who have tiles around a touch that reaches their nodes, and take in what they tell.
/// Shape functions end at `support` from a place, along every axis [cells].
template <int D>
void exchange_touches(Contact<D>& contact, const TileGrid<D>& grid, double support);

/// Tell those who have patches with nodes of contact the vector at number `at` of the nodes'
/// records, which contact has changed, and take over what they tell.
template <int D>
void exchange_responses(Contact<D>& contact, TileGrid<D>& grid, int at);

}  // namespace mpm
