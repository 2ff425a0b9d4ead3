#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/particles/cell_lists.hpp"

namespace mpm {
namespace {

struct Key {
  std::uint64_t value;  // tile (last axis highest), then cell
  std::uint32_t id, row;
};

template <int D>
std::uint64_t key_of(const Index<D>& tile, int cell) {
  // Three tile coordinates and the 64 cells of a tile: 3 x 19 + 6 = 63 bits of one integer. The
  // last axis is highest, so that keys are in the order of tile_less, and patches come out sorted.
  constexpr int bits = 19;
  constexpr std::int32_t half = 1 << (bits - 1);
  std::uint64_t key = 0;
  for (int a = D - 1; a >= 0; --a) {
    if (tile[a] < -half || tile[a] >= half)
      throw std::out_of_range("a particle lies too far away for the grid");
    key = key << bits | static_cast<std::uint64_t>(tile[a] + half);
  }
  return key << 6 | static_cast<std::uint64_t>(cell);
}

/// Add the patches of a body, whose particles are given by key and number, with their lists.
template <int D>
void add_patches(TileGrid<D>& grid, int body, bool keeps, const ParticlePool<D>& pool,
                 const std::vector<Key>& keys, std::vector<std::uint32_t>& order) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto [tile, cell] = grid.tile_and_cell(listed_place(pool, keys[i].row));
    if (i == 0 || grid.patches.back().tile != tile) {
      Patch<D>& made = grid.patches.emplace_back();
      made.body = body;
      made.keeps = keeps;
      made.tile = tile;
      made.begin = static_cast<std::uint32_t>(order.size());
    }
    Patch<D>& patch = grid.patches.back();
    patch.occupied |= std::uint64_t{1} << cell;
    ++patch.count;
    // Cells come in order: what is behind this one begins, as far as is known, at its end.
    for (int k = cell + 1; k <= Tile<D>::cell_count; ++k)
      patch.cell_begin[static_cast<std::size_t>(k)] = patch.count;
    order.push_back(keys[i].row);
    // Room in the range for some that come (decision 0040), so that few changes lay out lists anew.
    const bool last = i + 1 == keys.size() || keys[i + 1].value >> 6 != keys[i].value >> 6;
    if (!last) continue;
    patch.room = room_for(patch.count);
    order.resize(patch.begin + std::size_t{patch.room});
  }
}

/// for_each(f) calls f(body, position) for the particles.
template <int D, class ForEach>
void anchor_below(TileGrid<D>& grid, ForEach&& for_each) {
  // No two cells are further apart than this; counted from the lowest one in tiles of four they
  // stay below 2^18, half the range of a key. Written as !(a < b), for no number is too far as
  // well.
  constexpr double furthest = 1 << 20;  // cells; within the 19 bits of a key's tile coordinates
  grid.anchor.fill(std::numeric_limits<std::int32_t>::max());
  for_each([&](const Body<D>& body, const Vec<double, D>& x) {
    for (int a = 0; a < D; ++a)
      if (!(std::abs(grid.in_cells(x[a], a)) < 0.5 * furthest))
        throw std::invalid_argument("body \"" + body.name +
                                    "\" lies more than 2^19 cells from the grid's origin");
    const Index<D> cell = grid.cell_of(x);
    for (std::size_t a = 0; a < D; ++a) grid.anchor[a] = std::min(grid.anchor[a], cell[a]);
  });
  // The lowest of all ranks.
  double highest[D];
  for (std::size_t a = 0; a < D; ++a) highest[a] = -1.0 * grid.anchor[a];
  grid.partition.comm->all_max(highest);
  for (std::size_t a = 0; a < D; ++a) grid.anchor[a] = static_cast<std::int32_t>(-highest[a]);
}

}  // namespace

template <int D>
void place_anchor(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools) {
  anchor_below<D>(grid, [&](auto&& f) {
    for (const Patch<D>& patch : grid.patches) {
      const Body<D>& body = bodies[static_cast<std::size_t>(patch.body)];
      const ParticlePool<D>& pool = pools[static_cast<std::size_t>(body.material)];
      for (const std::uint32_t row : pool.rows(patch)) f(body, listed_place(pool, row));
    }
  });
}

template <int D>
void place_anchor(TileGrid<D>& grid, const std::vector<Body<D>>& bodies) {
  anchor_below<D>(grid, [&](auto&& f) {
    for (const Body<D>& body : bodies)
      for (std::size_t k = 0; body.given && k < body.given->count(); ++k)
        f(body, body.given->template position<D>(k));
  });
}

template <int D>
void build_cell_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                      std::vector<ParticlePool<D>>& pools, Threads& threads,
                      ListScratch<D>& scratch, std::optional<Owners<D>> owners) {
  const std::vector<Patch<D>> before = std::exchange(grid.patches, {});
  std::vector<std::vector<std::uint32_t>> orders(pools.size());
  for (std::size_t m = 0; m < pools.size(); ++m)
    orders[m].reserve(pools[m].count() + pools[m].count() / 4);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto m = static_cast<std::size_t>(bodies[b].material);
    std::vector<Key> keys;
    for_each_active_row(before, pools[m], static_cast<int>(b), [&](std::uint32_t row) {
      const auto [tile, cell] = grid.tile_and_cell(listed_place(pools[m], row));
      keys.push_back({key_of<D>(tile, cell), pools[m].id[row], row});
    });
    // By number within a cell: sums over its particles have one order wherever rows lie (decision
    // 0033).
    std::ranges::sort(keys, {}, [](const Key& k) { return std::pair(k.value, k.id); });
    add_patches(grid, static_cast<int>(b), bodies[b].keeps_nodes(), pools[m], keys, orders[m]);
  }
  for (std::size_t m = 0; m < pools.size(); ++m) {
    pools[m].used = orders[m].size();
    orders[m].resize(pools[m].used + spare_room(pools[m].used));
    pools[m].order = std::move(orders[m]);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b)
    // Each body's rows among themselves: one that moves beside one at rest is worth sorting alone.
    sort_columns(grid, bodies[b], patches_of<D>(grid.patches, static_cast<int>(b)),
                 pools[static_cast<std::size_t>(bodies[b].material)], threads, scratch);
  // At the start there are no nodes that could lend their memory; from here on there are.
  scratch.own.release_and_allocate(0);
  connect(grid);
  if (grid.partition.alone())
    cut_blocks(grid, threads);
  else
    divide(grid, bodies, pools, threads, scratch, std::move(owners));
}

template void place_anchor<2>(TileGrid<2>&, const std::vector<Body<2>>&,
                              const std::vector<ParticlePool<2>>&);
template void place_anchor<2>(TileGrid<2>&, const std::vector<Body<2>>&);
template void place_anchor<3>(TileGrid<3>&, const std::vector<Body<3>>&,
                              const std::vector<ParticlePool<3>>&);
template void place_anchor<3>(TileGrid<3>&, const std::vector<Body<3>>&);
template void build_cell_lists<2>(TileGrid<2>&, std::vector<Body<2>>&,
                                  std::vector<ParticlePool<2>>&, Threads&, ListScratch<2>&,
                                  std::optional<Owners<2>>);
template void build_cell_lists<3>(TileGrid<3>&, std::vector<Body<3>>&,
                                  std::vector<ParticlePool<3>>&, Threads&, ListScratch<3>&,
                                  std::optional<Owners<3>>);

}  // namespace mpm
