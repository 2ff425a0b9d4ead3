#pragma once
// The nodes of a patch's block: a box about the cells that hold the body's particles, with a margin
// before and behind them as the basis reaches. Nodes are counted from the tile's first.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "mpm/basis/basis.hpp"
#include "mpm/layout/tile.hpp"

namespace mpm {

template <int D>
struct BlockShape {
  Index<D> low{};                                     // the block's first node
  Index<D> nodes{};                                   // how many along each axis
  int node_count = 0;                                 // 0 without particles
  std::array<int, Tile<D>::corners> corner_offset{};  // from a node to a cube's corners

  static constexpr int count_max(int before, int after) {
    return power(Tile<D>::cells + before + after, D);
  }
  static constexpr int nodes_max = count_max(Bases::before_max, Bases::after_max);

  BlockShape() = default;
  /// Of the nodes from `first` to `last`.
  BlockShape(const Index<D>& first, const Index<D>& last) : low(first), node_count(1) {
    for (std::size_t a = 0; a < D; ++a) node_count *= nodes[a] = last[a] - first[a] + 1;
    for (int k = 0; k < Tile<D>::corners; ++k)
      corner_offset[static_cast<std::size_t>(k)] = distance(Tile<D>::corner(k));
  }
  /// Of the cells that hold particles, a bit each by Tile<D>::cell.
  static BlockShape around(std::uint64_t occupied, const Reach& reach) {
    if (occupied == 0) return {};
    Index<D> first, last;
    for (std::size_t a = 0; a < D; ++a) {
      int i = 0, j = Tile<D>::cells - 1;
      // Ends, for some cell is occupied.
      while (!(occupied & Tile<D>::slice(a, i))) ++i;
      while (!(occupied & Tile<D>::slice(a, j))) --j;
      first[a] = i - reach.before;
      last[a] = j + reach.after;
    }
    return {first, last};
  }

  Index<D> last() const {
    Index<D> i;
    for (std::size_t a = 0; a < D; ++a) i[a] = low[a] + nodes[a] - 1;
    return i;
  }
  /// Of all nodes from the least of both to the greatest.
  BlockShape joined_with(const BlockShape& other) const {
    if (node_count == 0) return other;
    if (other.node_count == 0) return *this;
    Index<D> first, end;
    for (std::size_t a = 0; a < D; ++a) {
      first[a] = std::min(low[a], other.low[a]);
      end[a] = std::max(last()[a], other.last()[a]);
    }
    return {first, end};
  }
  bool operator==(const BlockShape& other) const {
    return low == other.low && nodes == other.nodes;
  }

  /// Difference of node numbers for a difference of coordinates.
  int distance(const Index<D>& i) const {
    int n = 0;
    for (std::size_t a = D; a-- > 0;) n = n * nodes[a] + i[a];
    return n;
  }
  /// Number in the block of the node with these coordinates, and back.
  int node(Index<D> i) const {
    for (std::size_t a = 0; a < D; ++a) i[a] -= low[a];
    return distance(i);
  }
  Index<D> index(int n) const {
    Index<D> i{};
    for (std::size_t a = 0; a < D; ++a) {
      i[a] = n % nodes[a] + low[a];
      n /= nodes[a];
    }
    return i;
  }
  bool holds(const Index<D>& i) const {
    bool inside = true;
    for (std::size_t a = 0; a < D; ++a)
      inside = inside && i[a] >= low[a] && i[a] < low[a] + nodes[a];
    return inside;
  }
};

}  // namespace mpm
