// Nodes that several patches hold: each is owned once, by the first that holds it, is listed if
// there are others, and gets the sum of all in the order of the tiles, to the last bit.
#include <map>

#include "check.hpp"
#include "grid/tiles.hpp"
#include "mpm/grid/shared_nodes.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Who has one velocity field, and the node.
template <int D>
using Key = std::pair<int, Index<D>>;

template <int D>
Key<D> key_of(const TileGrid<D>& grid, std::size_t patch, const Index<D>& node) {
  return {grid.bonded ? 0 : grid.patches[patch].body, node};
}

/// The patches that are summed with their neighbours, in the order of the sums; each with those
/// that are secondary to it, in the order of the bodies.
template <int D>
std::vector<std::vector<std::size_t>> in_order(const TileGrid<D>& grid) {
  std::map<std::size_t, std::vector<std::size_t>> by_primary;
  for (std::size_t p = 0; p < grid.patches.size(); ++p)
    by_primary[grid.patches[p].primary].push_back(p);
  std::vector<std::vector<std::size_t>> order;
  order.reserve(by_primary.size());
  for (const auto& [primary, patches] : by_primary) order.push_back(patches);
  if (grid.bonded)
    std::ranges::sort(order, [&](const auto& x, const auto& y) {
      return tile_less<D>(grid.patches[x[0]].tile, grid.patches[y[0]].tile);
    });
  return order;
}

using Numbers = std::array<double, record + half_record>;  // of a node, and its dashpots

template <int D>
void read_node(const NodeBlock<D>& block, int n, Numbers& numbers) {
  std::copy_n(block.records[n], record, numbers.begin());
  std::copy_n(block.dashpots()[n], half_record, numbers.begin() + record);
}

void add(Numbers& to, const Numbers& from) {
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
}

/// A dense sum over a map from node to numbers, in that order.
template <int D>
std::map<Key<D>, Numbers> dense_sums(Tiles<D>& tiles) {
  std::vector<std::map<Index<D>, Numbers>> given(tiles.grid.patches.size());
  tiles.for_each_node([&](std::size_t p, int n, const Index<D>& node) {
    read_node(tiles.grid.block(p), n, given[p][node]);
  });
  std::map<Key<D>, Numbers> sums;
  for (const auto& patches : in_order(tiles.grid)) {
    std::map<Index<D>, Numbers> of_tile;
    for (const std::size_t p : patches)
      for (const auto& [node, numbers] : given[p])
        if (const auto [at, is_new] = of_tile.try_emplace(node, numbers); !is_new)
          add(at->second, numbers);
    for (const auto& [node, numbers] : of_tile) {
      const auto [at, is_new] = sums.try_emplace(key_of<D>(tiles.grid, patches[0], node), numbers);
      if (!is_new) add(at->second, numbers);
    }
  }
  return sums;
}

template <int D>
void sum(Tiles<D>& tiles, int first, int last) {
  sum_shared_nodes(tiles.grid, tiles.threads, first, last);
}
template <int D>
void sum_dashpots(Tiles<D>& tiles) {
  sum_shared_at_walls(tiles.grid, tiles.threads);
}

/// Half by half, so that no other may change with one, or `at_once`.
template <int D>
void check_sums(Report& report, Tiles<D>& tiles, bool at_once) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  tiles.for_each_node([&](std::size_t p, int n, const Index<D>&) {
    const NodeBlock<D> block = tiles.grid.block(p);
    for (int k = 0; k < record; ++k) block.records[n][k] = any(tiles.random);
    for (int k = 0; k < half_record; ++k) block.dashpots()[n][k] = any(tiles.random);
  });
  const auto sums = dense_sums(tiles);
  const auto check = [&](std::size_t first, std::size_t last) {
    tiles.for_each_node([&](std::size_t p, int n, const Index<D>& node) {
      Numbers found;
      read_node(tiles.grid.block(p), n, found);
      const Numbers& expected = sums.at(key_of<D>(tiles.grid, p, node));
      for (std::size_t k = first; k < last; ++k) CHECK_EQUAL(found[k], expected[k]);
    });
  };
  if (at_once) {
    sum(tiles, 0, record);
  } else {
    sum(tiles, force_at, record);
    check(force_at, record);
    sum(tiles, 0, force_at);
  }
  check(0, record);
  sum_dashpots(tiles);
  check(0, record + half_record);
}

/// The first of a node's patches owns it, and lists it by how many they are.
template <int D>
void check_owners(Report& report, const Tiles<D>& tiles) {
  const TileGrid<D>& grid = tiles.grid;
  std::map<Key<D>, std::vector<std::pair<std::size_t, int>>> holders;  // and their numbers of it
  std::map<Key<D>, int> owners;
  tiles.for_each_node([&](std::size_t p, int n, const Index<D>& node) {
    const Key<D> key = key_of<D>(grid, p, node);
    owners[key] += grid.patches[p].owned[n];
    if (grid.patches[p].primary == p) holders[key].emplace_back(p, n);
    CHECK(grid.patches[p].primary == p || !grid.patches[p].owned[n], p, n);
  });
  for (const auto& [key, count] : owners) CHECK_EQUAL(count, 1);
  std::map<std::size_t, std::map<std::size_t, int>> groups;
  for (const auto& [key, held_by] : holders) {
    const auto first = std::ranges::min_element(held_by, [&](const auto& x, const auto& y) {
      return tile_less<D>(grid.patches[x.first].tile, grid.patches[y.first].tile);
    });
    CHECK(grid.patches[first->first].owned[first->second], first->first, first->second);
    ++groups[first->first][held_by.size()];
  }
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    if (grid.patches[p].primary != p) continue;
    const SharedNodes<D>& shared = grid.patches[p].shared;
    std::size_t entries = 0;
    for (std::size_t m = 2; m <= SharedNodes<D>::most; ++m) {
      CHECK_EQUAL(static_cast<int>(shared.groups[m]), groups[p][m]);
      entries += m * shared.groups[m];
    }
    CHECK_EQUAL(shared.entries(), entries);
  }
}

template <int D>
void check_grid(Report& report, BasisId basis, bool bonded) {
  Tiles<D> tiles(basis, bonded);
  for (int round = 0; round < Tiles<D>::rounds; ++round) {
    tiles.cut();
    check_owners(report, tiles);
    check_sums(report, tiles, false);
    check_sums(report, tiles, true);
    tiles.change(round);
  }
}

}  // namespace

void test_shared_nodes(Report& report) {
  for_each_kind_of_grid([&](BasisId basis, bool bonded) {
    check_grid<2>(report, basis, bonded);
    check_grid<3>(report, basis, bonded);
  });
}
