#pragma once
// The nodes of a patch's block: those of its tile's cells and, for a basis that reaches further, a
// margin around them. Node i of an axis runs from -margin to cells + margin, 0 being the tile's
// first node.
#include <vector>

#include "mpm/basis/tile.hpp"

namespace mpm {

/// The nodes of a block that the same neighbours share: region r of {-1,0,1}^D holds the nodes
/// shared with the lower neighbour (-1), with none (0) or with the upper one (1) along each axis.
/// Numbered as the neighbours are.
struct Region {
  std::vector<std::int32_t> nodes;  // node numbers in the block
  std::vector<std::int32_t>
      sharers;  // neighbours that share them, in the order of the tiles, itself left out
};

template <int D>
struct BlockShape {
  int margin = 0;
  int nodes = 0;  // along an axis
  int node_count = 0;
  int node_stride = 0;  // length of one field [doubles], a whole number of cache lines
  std::array<int, Tile<D>::corners> corner_offset{};  // from a cell's first node to its corners
  std::array<Region, Tile<D>::neighbours> regions;
  std::array<int, Tile<D>::neighbours>
      shift{};  // node number here + shift = number in the neighbour's block
  std::vector<std::uint8_t> region_of_node;

  static constexpr int margin_max = 1;
  static constexpr int stride_max = (power(Tile<D>::cells + 1 + 2 * margin_max, D) + 7) / 8 * 8;

  explicit BlockShape(int margin_nodes = 0)
      : margin(margin_nodes), nodes(Tile<D>::cells + 1 + 2 * margin_nodes) {
    using T = Tile<D>;
    node_count = power(nodes, D);
    node_stride = (node_count + 7) / 8 * 8;
    for (int k = 0; k < T::corners; ++k)
      corner_offset[static_cast<std::size_t>(k)] = distance(T::corner(k));
    region_of_node.resize(static_cast<std::size_t>(node_count));
    for (int n = 0; n < node_count; ++n) {
      const Index<D> i = index(n);
      Index<D> r{};
      for (int a = 0; a < D; ++a) r[a] = i[a] <= margin ? -1 : (i[a] >= T::cells - margin ? 1 : 0);
      const auto k = static_cast<std::size_t>(T::neighbour(r));
      region_of_node[static_cast<std::size_t>(n)] = static_cast<std::uint8_t>(k);
      regions[k].nodes.push_back(n);
    }
    for (int k = 0; k < T::neighbours; ++k) {
      const Index<D> r = T::offset(k);
      shift[static_cast<std::size_t>(k)] = -T::cells * distance(r);
      for (int s = 0; s < T::neighbours; ++s) {
        const Index<D> o = T::offset(s);
        bool shares = s != T::self;
        for (int a = 0; a < D; ++a) shares = shares && (o[a] == 0 || o[a] == r[a]);
        if (shares) regions[static_cast<std::size_t>(k)].sharers.push_back(s);
      }
    }
  }

  /// Difference of node numbers for a difference of coordinates.
  int distance(const Index<D>& i) const {
    int n = 0;
    for (int a = D - 1; a >= 0; --a) n = n * nodes + i[a];
    return n;
  }
  /// Number in the block of the node with these coordinates from the tile's first node, and back.
  int node(Index<D> i) const {
    for (int a = 0; a < D; ++a) i[a] += margin;
    return distance(i);
  }
  Index<D> index(int n) const {
    Index<D> i{};
    for (int a = 0; a < D; ++a, n /= nodes) i[a] = n % nodes - margin;
    return i;
  }
  bool holds(const Index<D>& i) const {
    bool inside = true;
    for (int a = 0; a < D; ++a)
      inside = inside && i[a] >= -margin && i[a] <= Tile<D>::cells + margin;
    return inside;
  }
};

}  // namespace mpm
