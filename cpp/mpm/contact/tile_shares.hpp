#pragma once
#include <algorithm>
#include <cstddef>

namespace mpm {

/// Shares of the tiles of contact, which follow one another.
// Few, so that their sizes hardly change; enough to share them out evenly (decision 0014). The
// order is that of the tiles, however many shares there are: no sum and no solution sees where one
// ends.
struct TileShares {
  std::size_t tiles, count;

  TileShares(std::size_t of_tiles, int threads) : tiles(of_tiles) {
    constexpr std::size_t least_tiles = 32, per_thread = 8;
    count = std::clamp(tiles / least_tiles, std::size_t{1},
                       per_thread * static_cast<std::size_t>(threads));
  }
  /// The first tile of a share; of the share behind the last, all of them.
  std::size_t first(std::size_t share) const { return share * tiles / count; }
};

}  // namespace mpm
