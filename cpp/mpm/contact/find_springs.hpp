#pragma once
#include "mpm/contact/contact.hpp"
#include "mpm/contact/tile_touches.hpp"

namespace mpm {

/// Normals, springs and frictions of the pairs at a node whose sides are known, from the touches
/// around its tile. `place` are the node's coordinates in the grid. If the pairs are `made`, as
/// find_pairs() leaves them, only of those that are not stopped.
template <int D>
void find_springs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const ContactSettings& settings, const TileTouches<D>& touches,
                  ContactPart<D>& part, const ContactNode& node, const Index<D>& place, bool made);

}  // namespace mpm
