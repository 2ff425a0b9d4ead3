#pragma once
// The touches whose springs reach nodes of a tile, pair by pair.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "mpm/contact/contact.hpp"

namespace mpm {

/// How far along an axis nodes may be from a particle that touches, at most [cells]: its springs act
/// up to half an edge from it.
template <int D>
double touch_reach(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                   const Touch<D>& touch) {
  const double edge = bodies[static_cast<std::size_t>(touch.body)].mean_edge / grid.cell_size;
  return support(grid.basis, edge) + touch.half;
}

template <int D>
class TileTouches {
 public:
  /// Forget all and take those in and around another tile, number t of Contact::tiles, that reach
  /// some of its nodes.
  void gather(const Contact<D>& contact, const TileGrid<D>& grid,
              const std::vector<Body<D>>& bodies, std::size_t t) {
    touches_.clear();
    nodes_ = 0;
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const std::int64_t number = contact.around[t][static_cast<std::size_t>(k)];
      if (number < 0) continue;
      const TouchRange& range = contact.tiles[static_cast<std::size_t>(number)].touches;
      if (range.count == 0) continue;
      const Index<D> offset = Tile<D>::offset(k);
      for (const Touch<D>& touch :
           std::span(&contact.touches[range.share][range.first], range.count)) {
        Touch<D> here = touch;
        for (int a = 0; a < D; ++a) here.x[a] += Tile<D>::cells * offset[static_cast<std::size_t>(a)];
        const std::uint64_t nodes = nodes_near(here.x, touch_reach(grid, bodies, touch));
        if (nodes == 0) continue;
        nodes_ |= nodes;
        touches_.push_back(here);
      }
    }
    // In the order they came within a pair: that of the tiles.
    std::ranges::stable_sort(touches_, {}, of_touch);
  }

  /// The tile's nodes that any of them may reach, a bit each by Tile<D>::cell.
  std::uint64_t nodes() const { return nodes_; }
  /// Those of a pair of bodies, in either order.
  std::span<const Touch<D>> between(std::int32_t r, std::int32_t s) const {
    const auto found = std::ranges::equal_range(touches_, pair_of(r, s), {}, of_touch);
    return {found.begin(), found.end()};
  }

 private:
  using Pair = std::pair<std::int32_t, std::int32_t>;
  static Pair pair_of(std::int32_t r, std::int32_t s) { return {std::min(r, s), std::max(r, s)}; }
  static Pair of_touch(const Touch<D>& touch) { return pair_of(touch.body, touch.other); }
  /// Nodes of the tile, 64 in 2D and 3D, less than `reach` from a point along every axis.
  static std::uint64_t nodes_near(const Vec<double, D>& x, double reach) {
    std::uint64_t nodes = ~std::uint64_t{0};
    for (int a = 0; a < D; ++a) {
      std::uint64_t along = 0;
      for (int i = 0; i < Tile<D>::cells; ++i)
        if (std::abs(x[a] - i) < reach) along |= Tile<D>::slice(static_cast<std::size_t>(a), i);
      nodes &= along;
    }
    return nodes;
  }

  std::vector<Touch<D>> touches_;
  std::uint64_t nodes_ = 0;
};

}  // namespace mpm
