#pragma once
// Which rank has which tiles: each a range of a Hilbert curve, so that what it has is compact.
// Tiles without particles have an owner too.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "mpm/layout/tile.hpp"
#include "mpm/math/hilbert.hpp"

namespace mpm {

/// The place of a tile along the curve; tiles that are too far away for it have those of its ends.
template <int D>
std::uint64_t place_of(const Index<D>& tile) {
  constexpr int bits = 19;  // as many as the keys of lists have
  constexpr std::int32_t half = 1 << (bits - 1);
  std::array<std::uint32_t, D> x;
  for (std::size_t a = 0; a < D; ++a)
    x[a] = static_cast<std::uint32_t>(std::clamp(tile[a], -half, half - 1) + half);
  return hilbert_number<D>(x, bits);
}

/// Empty tiles outside of those that were occupied when these were chosen go with the nearest of
/// these: else the surface of a body would be beside tiles of ranks that have nothing there.
template <int D>
struct Owners {
  std::vector<std::uint64_t> first{0};  // place of each rank's first tile; that of rank 0 is 0
  Index<D> low, high;                   // of the occupied tiles

  Owners() {
    low.fill(std::numeric_limits<std::int32_t>::min());
    high.fill(std::numeric_limits<std::int32_t>::max());
  }
  std::uint64_t place(Index<D> tile) const {
    for (std::size_t a = 0; a < D; ++a) tile[a] = std::clamp(tile[a], low[a], high[a]);
    return place_of<D>(tile);
  }
  int rank_of(const Index<D>& tile) const {
    if (first.size() == 1) return 0;
    const auto next = std::ranges::upper_bound(first, place(tile));
    return static_cast<int>(next - first.begin()) - 1;
  }
};

}  // namespace mpm
