#pragma once
#include <optional>

#include "mpm/particles/cell_lists.hpp"

namespace mpm {

/// Choose which ranks have which tiles by the particles that are given, and give these to the ranks
/// that have theirs. By all ranks at once; nothing if this one is alone.
template <int D>
std::optional<Owners<D>> give_to_owners(TileGrid<D>& grid, std::vector<Body<D>>& bodies);

}  // namespace mpm
