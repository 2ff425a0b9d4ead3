// The nodal blocks: which nodes a patch has, and where they are in memory.
#include <algorithm>

#include "mpm/grid/tile_grid.hpp"

namespace mpm {
namespace {

template <int D>
bool box_touches_wall(const TileGrid<D>& grid, const Patch<D>& patch) {
  if (!grid.walls.exist || patch.shape.node_count == 0) return false;
  const Index<D> first = grid.first_cell(patch.tile), last = patch.shape.last();
  for (std::size_t a = 0; a < D; ++a) {
    const bool lower = first[a] + patch.shape.low[a] <= 0 && grid.walls.face[a][0] != Wall::free;
    const bool upper =
        first[a] + last[a] >= grid.walls.cells[a] && grid.walls.face[a][1] != Wall::free;
    if (lower || upper) return true;
  }
  return false;
}

}  // namespace

/// Find the shapes of the blocks; false if none has changed.
template <int D>
bool TileGrid<D>::find_shapes(Threads& threads) {
  reshaped_.assign(patches.size(), bonded);
  threads.for_each(patches.size(), [&](std::size_t p) {
    const auto shape = BlockShape<D>::around(patches[p].occupied, reach());
    if (patches[p].shape == shape) return;
    patches[p].shape = shape;
    reshaped_[p] = true;
  });
  if (bonded)
    for (const std::uint32_t p : by_tile_) {
      BlockShape<D>& all = patches[patches[p].primary].shape;
      all = all.joined_with(patches[p].shape);
    }
  return std::ranges::any_of(reshaped_, [](std::uint8_t yes) { return yes; });
}

template <int D>
void TileGrid<D>::cut_blocks(Threads& threads) {
  if (!find_shapes(threads) && blocks_known_) return;
  blocks_known_ = true;
  needed_ = 0;
  for (Patch<D>& patch : patches) {
    patch.memory = needed_;
    const auto nodes = static_cast<std::size_t>(patch.shape.node_count);
    needed_ += record * (nodes + (has_dashpots ? (nodes + 1) / 2 : 0));  // whole cache lines
  }
  make_room(node_memory_, needed_, needed_ + needed_ / 16);
  threads.for_each(patches.size(), [&](std::size_t p) {
    Patch<D>& patch = patches[p];
    patch.at_wall = box_touches_wall(*this, patch);
    if (patch.primary != p) patch.owned.fill(0);
  });
  list_shared_nodes(threads);
}

template void TileGrid<2>::cut_blocks(Threads&);
template void TileGrid<3>::cut_blocks(Threads&);

}  // namespace mpm
