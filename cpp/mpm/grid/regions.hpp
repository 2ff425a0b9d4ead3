#pragma once
// A block's nodes by who shares them: region r of {-1,0,1}^D holds the nodes at the lower end (-1), inside (0) or at the
// upper end (1) along each axis. Numbered as the neighbours are.
#include "mpm/grid/tile.hpp"

namespace mpm {

template <int D>
struct Region {
  std::array<std::int16_t, power(Tile<D>::nodes, D - 1)> node{};  // node numbers in the block
  int node_count = 0;
  std::array<std::int8_t, (1 << D) - 1> sharer{};  // neighbours that share it, in the order of the tiles, itself left out
  int sharer_count = 0;
};

template <int D>
constexpr std::array<Region<D>, Tile<D>::neighbours> make_regions() {
  using T = Tile<D>;
  std::array<Region<D>, T::neighbours> regions{};
  for (int n = 0; n < T::node_count; ++n) {
    const Index<D> i = T::node_index(n);
    Index<D> r{};
    for (int a = 0; a < D; ++a) r[a] = i[a] == 0 ? -1 : (i[a] == T::cells ? 1 : 0);
    const int k = T::neighbour(r);
    if (k == T::self) continue;  // shared with nobody
    auto& region = regions[static_cast<std::size_t>(k)];
    region.node[static_cast<std::size_t>(region.node_count++)] = static_cast<std::int16_t>(n);
  }
  for (int k = 0; k < T::neighbours; ++k) {
    const Index<D> r = T::offset(k);
    auto& region = regions[static_cast<std::size_t>(k)];
    for (int s = 0; s < T::neighbours; ++s) {
      const Index<D> o = T::offset(s);
      bool shares = s != T::self;
      for (int a = 0; a < D; ++a) shares = shares && (o[a] == 0 || o[a] == r[a]);
      if (shares) region.sharer[static_cast<std::size_t>(region.sharer_count++)] = static_cast<std::int8_t>(s);
    }
  }
  return regions;
}

template <int D>
inline constexpr auto regions = make_regions<D>();

/// What to add to a node's number in a block to get it in the block of neighbour k.
template <int D>
constexpr std::array<int, Tile<D>::neighbours> make_node_shift() {
  std::array<int, Tile<D>::neighbours> shift{};
  for (int k = 0; k < Tile<D>::neighbours; ++k) {
    const Index<D> o = Tile<D>::offset(k);
    int s = 0;
    for (int a = D - 1; a >= 0; --a) s = s * Tile<D>::nodes + o[a];
    shift[static_cast<std::size_t>(k)] = -Tile<D>::cells * s;
  }
  return shift;
}

template <int D>
inline constexpr auto node_shift = make_node_shift<D>();

/// The region of each node of a block.
template <int D>
constexpr std::array<std::uint8_t, Tile<D>::node_count> make_region_of_node() {
  std::array<std::uint8_t, Tile<D>::node_count> r{};
  for (auto& k : r) k = Tile<D>::self;
  for (int k = 0; k < Tile<D>::neighbours; ++k) {
    const auto& region = regions<D>[static_cast<std::size_t>(k)];
    for (int i = 0; i < region.node_count; ++i)
      r[static_cast<std::size_t>(region.node[static_cast<std::size_t>(i)])] = static_cast<std::uint8_t>(k);
  }
  return r;
}

template <int D>
inline constexpr auto region_of_node = make_region_of_node<D>();

}  // namespace mpm
