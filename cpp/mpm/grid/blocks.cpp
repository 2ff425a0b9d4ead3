#include "mpm/grid/blocks.hpp"

#include <algorithm>

#include "mpm/grid/halo.hpp"
#include "mpm/grid/shared_nodes.hpp"

namespace mpm {
namespace {

template <int D>
bool box_touches_wall(const TileGrid<D>& grid, const Patch<D>& patch) {
  if (!grid.walls.exist || patch.shape.node_count == 0) return false;
  const Index<D> first = grid.first_cell(patch.tile), last = patch.shape.last();
  for (std::size_t a = 0; a < D; ++a) {
    // Walls lie at the nodes 0 and `cells` of the box, by index, and not at a tile's edge.
    // One that touches pushes the nodes before it, too.
    for (const int side : {0, 1}) {
      const Wall wall = grid.walls.face[a][side];
      const int before =
          side == 0 ? first[a] + patch.shape.low[a] : grid.walls.cells[a] - (first[a] + last[a]);
      if (wall != Wall::free && before <= (wall == Wall::contact ? 1 : 0)) return true;
    }
  }
  return false;
}

/// Find the shapes of the blocks; false if none has changed.
template <int D>
bool find_shapes(TileGrid<D>& grid, Threads& threads) {
  std::vector<Patch<D>>& patches = grid.patches;
  // Where bodies are bonded a primary's block may change by what its secondary patches do, so all
  // lists are made anew.
  grid.reshaped.assign(patches.size(), grid.bonded);
  threads.for_each(patches.size(), [&](std::size_t p) {
    // A look at one word of bits; blocks that stay as they are keep their lists of shared nodes.
    const auto shape = BlockShape<D>::around(patches[p].cells(), grid.reach());
    if (patches[p].shape == shape) return;
    patches[p].shape = shape;
    grid.reshaped[p] = true;
  });
  if (grid.bonded)
    for (const std::uint32_t p : grid.by_tile) {
      // The primary takes the sums of all bodies in its tile, so it needs every node that any of
      // them has.
      BlockShape<D>& all = patches[patches[p].primary].shape;
      all = all.joined_with(patches[p].shape);
    }
  return std::ranges::any_of(grid.reshaped, [](std::uint8_t yes) { return yes; });
}

}  // namespace

template <int D>
void cut_blocks(TileGrid<D>& grid, Threads& threads) {
  if (!find_shapes(grid, threads) && grid.blocks_known) return;
  grid.blocks_known = true;
  std::size_t needed = 0, kept = 0;
  grid.patches_with_particles = grid.records_with_particles = 0;
  for (Patch<D>& patch : grid.patches) {
    // One behind another in the order of the patches. Nothing in a block outlives a step, so they
    // may move freely (decision 0013). Those that keep their nodes stay where they are, as their
    // patches and cells do.
    patch.memory = patch.keeps ? kept : needed;
    patch.at_wall = box_touches_wall(grid, patch);
    if (patch.occupied != 0) {
      ++grid.patches_with_particles;
      // Of its own cells: which patch has the nodes of bonded ones is no matter of the case.
      const int own = BlockShape<D>::around(patch.occupied, grid.reach()).node_count;
      grid.records_with_particles += grid.numbers_of_block(own, patch.at_wall) / record;
    }
    if (patch.keeps)
      kept += grid.numbers_kept(patch.shape.node_count);
    else
      needed += grid.numbers_of_block(patch.shape.node_count, patch.at_wall);
  }
  grid.nodes.needed = needed;
  make_room(grid.nodes.numbers, needed, needed + needed / 16);
  grid.kept.needed = kept;
  make_room(grid.kept.numbers, kept, kept);
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    Patch<D>& patch = grid.patches[p];
    if (patch.primary != p) patch.owned.fill(0);
  });
  list_shared_nodes(grid, threads);
  if (!grid.partition.alone()) plan_halo(grid);
}

template void cut_blocks<2>(TileGrid<2>&, Threads&);
template void cut_blocks<3>(TileGrid<3>&, Threads&);

}  // namespace mpm
