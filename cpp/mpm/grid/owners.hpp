#pragma once
// Which rank has which tiles: each a range of a Hilbert curve, so that what it has is compact.
// Tiles without particles have an owner too.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "mpm/layout/tile.hpp"
#include "mpm/math/hilbert.hpp"

namespace mpm {

/// Empty tiles outside of those that were occupied when these were chosen go with the nearest of
/// these: else the surface of a body would be beside tiles of ranks that have nothing there.
template <int D>
struct Owners {
  std::vector<std::uint64_t> first{0};  // place of each rank's first tile; that of rank 0 is 0

  /// The box of the occupied tiles. Along each axis its middle is that of the least cube of the
  /// curve that is as long: halves of the curve are halves of the box then, with flat cuts.
  void set_box(const Index<D>& low, const Index<D>& high) {
    low_ = low;
    high_ = high;
    for (std::size_t a = 0; a < D; ++a) {
      const auto length = static_cast<std::uint32_t>(high[a] - low[a]) + 1;
      before_[a] = (std::bit_ceil(length) - length) / 2;
    }
  }
  /// The place of a tile along the curve.
  std::uint64_t place(const Index<D>& tile) const {
    std::array<std::uint32_t, D> x;
    for (std::size_t a = 0; a < D; ++a)
      x[a] =
          static_cast<std::uint32_t>(std::clamp(tile[a], low_[a], high_[a]) - low_[a]) + before_[a];
    return hilbert_number<D>(x, bits);
  }
  int rank_of(const Index<D>& tile) const {
    if (first.size() == 1) return 0;
    const auto next = std::ranges::upper_bound(first, place(tile));
    return static_cast<int>(next - first.begin()) - 1;
  }
  bool operator==(const Owners&) const = default;
  static constexpr int bits = 19;  // of a place along each axis, as many as the keys of lists have

 private:
  Index<D> low_{}, high_{};
  std::array<std::uint32_t, D>
      before_{};  // tiles between the begin of the curve's cube and the box
};

}  // namespace mpm
