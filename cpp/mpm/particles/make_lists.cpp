#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "mpm/particles/lists.hpp"

namespace mpm {
namespace {

struct Key {
  std::uint64_t value;  // tile (last axis highest), then cell
  std::uint32_t id, row;
};

template <int D>
std::uint64_t key_of(const Index<D>& tile, int cell) {
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

template <int D>
Vec<double, D> position(const Body<D>& body, std::size_t i) {
  Vec<double, D> x;
  for (int a = 0; a < D; ++a) x[a] = body.x(a)[i];
  return x;
}

template <int D>
void add_patches(TileGrid<D>& grid, const Body<D>& body, int body_number) {
  for (std::size_t i = 0; i < body.active(); ++i) {
    const Index<D> cell = grid.cell_of(position(body, i));
    const Index<D> tile = grid.tile_of(cell);
    const Index<D> first = grid.first_cell(tile);
    Index<D> local;
    for (int a = 0; a < D; ++a) local[a] = cell[a] - first[a];
    const int c = Tile<D>::cell(local);
    if (i == 0 || grid.patches.back().tile != tile) {
      Patch<D> p;
      p.body = body_number;
      p.tile = tile;
      p.begin = static_cast<std::uint32_t>(i);
      grid.patches.push_back(p);
    }
    Patch<D>& p = grid.patches.back();
    p.occupied |= std::uint64_t{1} << c;
    ++p.count;
    for (int k = c + 1; k <= Tile<D>::cell_count; ++k)
      p.cell_begin[static_cast<std::size_t>(k)] = p.count;
  }
}

}  // namespace

template <int D>
void make_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies, Threads& threads,
                ListScratch<D>& scratch) {
  constexpr double furthest = 1 << 20;  // cells; within the 19 bits of a key's tile coordinates
  grid.anchor.fill(std::numeric_limits<std::int32_t>::max());
  for (auto& body : bodies) {
    if (body.order.size() != body.count()) {  // for the first time
      body.order.resize(body.count());
      std::iota(body.order.begin(), body.order.end(), 0u);
    }
    for (std::size_t k = 0; k < body.active(); ++k) {
      const Vec<double, D> x = position(body, body.order[k]);
      for (int a = 0; a < D; ++a)
        if (!(std::abs(grid.in_cells(x[a], a)) < 0.5 * furthest))
          throw std::invalid_argument("body \"" + body.name +
                                      "\" lies more than 2^19 cells from the grid's origin");
      const Index<D> cell = grid.cell_of(x);
      for (int a = 0; a < D; ++a) grid.anchor[a] = std::min(grid.anchor[a], cell[a]);
    }
  }
  grid.patches.clear();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Body<D>& body = bodies[b];
    const std::size_t n = body.active();
    {
      std::vector<Key> keys(n);
      for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t row = body.order[i];
        const Index<D> cell = grid.cell_of(position(body, row));
        const Index<D> tile = grid.tile_of(cell);
        const Index<D> first = grid.first_cell(tile);
        Index<D> local;
        for (int a = 0; a < D; ++a) local[a] = cell[a] - first[a];
        keys[i] = {key_of<D>(tile, Tile<D>::cell(local)), body.id[row], row};
      }
      std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
        return x.value != y.value ? x.value < y.value : x.id < y.id;
      });
      for (std::size_t i = 0; i < n; ++i) body.order[i] = keys[i].row;
    }
    sort_columns(grid, body, threads, scratch);
    add_patches(grid, body, static_cast<int>(b));
  }
  scratch.own.release_and_allocate(0);
  grid.connect();
  grid.cut_blocks(threads);
}

template void make_lists<2>(TileGrid<2>&, std::vector<Body<2>>&, Threads&, ListScratch<2>&);
template void make_lists<3>(TileGrid<3>&, std::vector<Body<3>>&, Threads&, ListScratch<3>&);

}  // namespace mpm
