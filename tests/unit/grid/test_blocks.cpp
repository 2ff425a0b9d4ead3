// Blocks cut to the occupied cells: all nodes in reach of one are there, and no smaller box holds
// them; no two blocks share memory; and who is at a wall knows it.
#include <algorithm>

#include "check.hpp"
#include "grid/tiles.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

template <int D>
void check_shapes(Report& report, const TileGrid<D>& grid) {
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const Patch<D>& patch = grid.patches[p];
    if (grid.bonded && patch.primary == p) continue;
    Index<D> first, last;
    first.fill(99);
    last.fill(-99);
    for (int c = 0; c < Tile<D>::cell_count; ++c)
      for (std::size_t a = 0; a < D && (patch.occupied >> c & 1u); ++a) {
        first[a] = std::min(first[a], Tile<D>::cell_index(c)[a] - grid.reach().before);
        last[a] = std::max(last[a], Tile<D>::cell_index(c)[a] + grid.reach().after);
      }
    if (patch.occupied == 0) {
      CHECK_EQUAL(patch.shape.node_count, 0);
    } else {
      CHECK(patch.shape.low == first && patch.shape.last() == last, p);
    }
  }
}

template <int D>
void check_memory(Report& report, TileGrid<D>& grid) {
  std::vector<const double*> used;  // beginning and end of each block, with its dashpots
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const NodeBlock<D> block = grid.block(p);
    if (block.count == 0) continue;
    used.push_back(block.records.data);
    used.push_back(block.dashpots().data + half_record * block.count);
    const auto line = reinterpret_cast<std::uintptr_t>(block.records.data);
    CHECK_EQUAL(line % 64, std::uintptr_t{0});  // a node's record is one cache line
  }
  CHECK(std::ranges::is_sorted(used));
}

/// A box of which the faces pass through the middle tile: a patch is at a wall if a node of its
/// block lies on or beyond a face that is not free.
template <int D>
void check_walls(Report& report, Tiles<D>& tiles) {
  TileGrid<D>& grid = tiles.grid;
  grid.walls.exist = true;
  grid.walls.cells.fill(Tile<D>::cells - 1);
  grid.walls.face[0][0] = Wall::slip;
  grid.walls.face[1][1] = Wall::fixed;
  tiles.connect();  // so that the blocks are cut anew
  tiles.cut();
  std::vector<bool> at_wall(grid.patches.size(), false);
  tiles.for_each_node([&](std::size_t p, int, const Index<D>& node) {
    if (node[0] <= 0 || node[1] >= grid.walls.cells[1]) at_wall[p] = true;
  });
  for (std::size_t p = 0; p < grid.patches.size(); ++p)
    CHECK_EQUAL(grid.patches[p].at_wall, at_wall[p]);
}

template <int D>
void check_blocks(Report& report, BasisId basis, bool bonded) {
  Tiles<D> tiles(basis, bonded);
  for (int round = 0; round < Tiles<D>::rounds; ++round) {
    tiles.cut();
    check_shapes(report, tiles.grid);
    check_memory(report, tiles.grid);
    tiles.change(round);
  }
  check_walls(report, tiles);
}

}  // namespace

void test_blocks(Report& report) {
  for_each_kind_of_grid([&](BasisId basis, bool bonded) {
    check_blocks<2>(report, basis, bonded);
    check_blocks<3>(report, basis, bonded);
  });
}
