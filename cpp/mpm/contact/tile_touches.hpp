#pragma once
// The touches whose springs reach nodes of a tile, pair by pair.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "mpm/contact/contact.hpp"

namespace mpm {

/// A touch at a tile, x from the tile's first node.
template <int D>
struct NearTouch : Touch<D> {
  std::uint64_t nodes;  // of the tile that it may reach, a bit each by Tile<D>::cell
  std::uint32_t order;  // in which they came, that of the tiles
};

template <int D>
class TileTouches {
 public:
  /// Forget all and take those in and around another tile, number t of Contact::tiles, that reach
  /// some of its nodes. Shape functions end at `support` from a place, along every axis [cells].
  void gather(const Contact<D>& contact, std::size_t t, double support) {
    touches_.clear();
    nodes_ = 0;
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const std::int32_t number = contact.around[t][static_cast<std::size_t>(k)];
      if (number < 0) continue;
      const Index<D> offset = Tile<D>::offset(k);
      for (const Touch<D>& touch : touches_in(contact, static_cast<std::size_t>(number))) {
        NearTouch<D> here{touch, 0, static_cast<std::uint32_t>(touches_.size())};
        for (int a = 0; a < D; ++a)
          here.x[a] += Tile<D>::cells * offset[static_cast<std::size_t>(a)];
        here.nodes = nodes_near(here.place(), support);
        if (here.nodes == 0) continue;
        nodes_ |= here.nodes;
        touches_.push_back(here);
      }
    }
    // Within a pair they stay in the order of the tiles, so that sums are the same after a restart.
    std::ranges::sort(touches_, {}, [](const NearTouch<D>& touch) {
      return std::pair(of_touch(touch), touch.order);
    });
  }

  /// The tile's nodes that any of them may reach, a bit each by Tile<D>::cell.
  std::uint64_t nodes() const { return nodes_; }
  /// Those of a pair of bodies, in either order.
  std::span<const NearTouch<D>> between(std::int32_t r, std::int32_t s) const {
    const auto found = std::ranges::equal_range(touches_, pair_of(r, s), {}, of_touch);
    return {found.begin(), found.end()};
  }

  /// Those of a tile's nodes, 64 in 2D and 3D, nearer to a place than that along every axis.
  static std::uint64_t nodes_near(const Vec<double, D>& place, double reach) {
    std::uint64_t nodes = ~std::uint64_t{0};
    for (int a = 0; a < D; ++a) {
      std::uint64_t along = 0;
      for (int i = 0; i < Tile<D>::cells; ++i)
        if (std::abs(place[a] - i) < reach) along |= Tile<D>::slice(static_cast<std::size_t>(a), i);
      nodes &= along;
    }
    return nodes;
  }

 private:
  /// Of particles in a tile, by its number in Contact::around.
  static std::span<const Touch<D>> touches_in(const Contact<D>& contact, std::size_t number) {
    if (number < contact.tiles.size()) {
      const TouchRange& range = contact.tiles[number].touches;
      return {contact.touches[range.share].data() + range.first, range.count};
    }
    const ForeignTile<D>& tile = contact.foreign_tiles[number - contact.tiles.size()];
    return {contact.foreign_touches.data() + tile.first, tile.count};
  }
  using Pair = std::pair<std::int32_t, std::int32_t>;
  static Pair pair_of(std::int32_t r, std::int32_t s) { return {std::min(r, s), std::max(r, s)}; }
  static Pair of_touch(const NearTouch<D>& touch) { return pair_of(touch.body, touch.other); }
  std::vector<NearTouch<D>> touches_;
  std::uint64_t nodes_ = 0;
};

}  // namespace mpm
