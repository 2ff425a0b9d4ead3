// From positions to cells, tiles and nodes and back; and who a patch's neighbours are.
#include <map>

#include "check.hpp"
#include "grid/tiles.hpp"

namespace {

using namespace mpm;

template <int D>
void check_places(mpm::testing::Report& report, BasisId basis) {
  TileGrid<D> grid;
  grid.cell_size = 0.5;
  grid.basis = basis;
  for (int a = 0; a < D; ++a) grid.origin[a] = 10.0 + a;
  grid.anchor.fill(3);
  const double own = grid.reach().own_node;  // of a cell's own node, in the cell
  for (int k = -20; k <= 20; ++k) {
    Index<D> node;
    node.fill(k);
    const Vec<double, D> at = grid.position_of(node);
    for (int a = 0; a < D; ++a) {
      CHECK_CLOSE(at[a], 10.0 + a + 0.5 * k, 1e-14);
      CHECK_CLOSE(grid.among_nodes(at[a], a), k, 1e-12);
      CHECK_CLOSE(grid.in_cells(at[a], a), k + own, 1e-12);
    }
    // A cell holds its own node, where that is not on its face, and what lies beside it.
    Vec<double, D> beside = at;
    for (int a = 0; a < D; ++a) beside[a] += 0.1;
    CHECK(grid.cell_of(beside) == node, k);
    const Index<D> tile = grid.tile_of(node), first = grid.first_cell(tile);
    for (std::size_t a = 0; a < D; ++a)
      CHECK(first[a] <= k && k < first[a] + Tile<D>::cells && (first[a] - 3) % Tile<D>::cells == 0,
            k, first[a]);
  }
  CHECK(local_coordinate(4.0, 4.0) > 0.0 && local_coordinate(5.0, 4.0) < 1.0);
}

template <int D>
int find(const TileGrid<D>& grid, int body, const Index<D>& tile) {
  return find_patch<D>(grid, body, tile);
}

/// The neighbours of a patch are those of its body in the tiles around it; of bonded bodies, of the
/// first with particles in each tile the first ones.
template <int D>
void check_neighbours(mpm::testing::Report& report, bool bonded) {
  const mpm::testing::Tiles<D> tiles(basis_id<Linear>, bonded);
  const TileGrid<D>& grid = tiles.grid;
  std::map<std::pair<int, Index<D>>, int> at;
  std::map<Index<D>, int> first;
  for (int p = 0; const Patch<D>& patch : grid.patches) {
    at[{patch.body, patch.tile}] = p;
    const auto [leader, is_first] = first.try_emplace(patch.tile, p);
    const auto& before = grid.patches[static_cast<std::size_t>(leader->second)];
    if (!is_first && before.cells() == 0 && patch.cells() != 0) leader->second = p;
    ++p;
  }
  CHECK(leaders_are_known(grid));
  const auto found = [](const auto& map, const auto& key) {
    const auto entry = map.find(key);
    return entry == map.end() ? -1 : entry->second;
  };
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const Patch<D>& patch = grid.patches[p];
    CHECK_EQUAL(static_cast<int>(patch.primary), bonded ? first[patch.tile] : static_cast<int>(p));
    if (patch.primary != p) continue;
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      Index<D> tile = patch.tile;
      for (std::size_t a = 0; a < D; ++a) tile[a] += Tile<D>::offset(k)[a];
      const int expected = bonded ? found(first, tile) : found(at, std::pair(patch.body, tile));
      CHECK_EQUAL(patch.neighbour[static_cast<std::size_t>(k)], expected);
    }
  }
  Index<D> low, high;
  low.fill(-2);
  high.fill(2);
  for (int body = -1; body < 4; ++body)
    for_each_index<D>(low, high, [&](const Index<D>& tile) {
      CHECK_EQUAL(find<D>(grid, body, tile), found(at, std::pair(body, tile)));
    });
}

/// Two bodies with a tile each, one beside the other: only if they are bonded do they know of it.
template <int D>
void check_two_bodies(mpm::testing::Report& report, bool bonded) {
  mpm::testing::Tiles<D> tiles(basis_id<Linear>, bonded);
  std::vector<Patch<D>>& patches = tiles.grid.patches;
  patches.assign(2, {});
  patches[1].body = 1;
  patches[1].tile[0] = 1;
  tiles.connect();
  for (std::size_t p = 0; p < 2; ++p)
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const int step = p == 0 ? 1 : -1;
      const bool beside = bonded && k == Tile<D>::self + step;
      const int expected = k == Tile<D>::self ? static_cast<int>(p)
                           : beside           ? 1 - static_cast<int>(p)
                                              : -1;
      CHECK_EQUAL(patches[p].neighbour[static_cast<std::size_t>(k)], expected);
    }
}

/// Of two bonded bodies in a tile the first leads until it is empty.
template <int D>
void check_leaders(mpm::testing::Report& report) {
  mpm::testing::Tiles<D> tiles(basis_id<Linear>, true);
  std::vector<Patch<D>>& patches = tiles.grid.patches;
  patches.assign(2, {});
  patches[1].body = 1;
  patches[0].occupied = patches[1].occupied = 1;
  tiles.connect();
  CHECK(patches[0].primary == 0 && patches[1].primary == 0);
  patches[0].occupied = 0;
  CHECK(!leaders_are_known(tiles.grid));
  tiles.connect();
  CHECK(patches[0].primary == 1 && patches[1].primary == 1 && leaders_are_known(tiles.grid));
}

}  // namespace

void test_connect(mpm::testing::Report& report) {
  Bases::for_each([&](BasisId id, const auto&) {
    check_places<2>(report, id);
    check_places<3>(report, id);
  });
  for (const bool bonded : {false, true}) {
    check_neighbours<2>(report, bonded);
    check_neighbours<3>(report, bonded);
    check_two_bodies<2>(report, bonded);
    check_two_bodies<3>(report, bonded);
  }
  check_leaders<2>(report);
  check_leaders<3>(report);
}
