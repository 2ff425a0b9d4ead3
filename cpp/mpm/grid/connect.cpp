#include "mpm/grid/connect.hpp"

#include <algorithm>
#include <numeric>

namespace mpm {
namespace {

/// In the order of the primaries: by body and tile, or by tile alone where bodies are bonded.
template <int D>
bool before(const TileGrid<D>& grid, const Patch<D>& p, int body, const Index<D>& tile) {
  return grid.bonded ? tile_less<D>(p.tile, tile) : patch_less<D>(p.body, p.tile, body, tile);
}

/// In a tile the lowest body leads that has particles there. Empty patches may stay a while, with
/// one number of ranks longer than with another: they come last, so that no sum is shared out
/// between patches by how long.
template <int D>
bool leads(const Patch<D>& p, const Patch<D>& q) {
  if (p.tile != q.tile) return tile_less<D>(p.tile, q.tile);
  const bool empty = p.cells() == 0;
  return empty != (q.cells() == 0) ? !empty : p.body < q.body;
}

template <int D>
void choose_primaries(TileGrid<D>& grid) {
  std::vector<Patch<D>>& patches = grid.patches;
  std::vector<std::uint32_t>& primaries = grid.primaries;
  primaries.resize(patches.size());
  std::iota(primaries.begin(), primaries.end(), 0u);
  for (std::uint32_t p = 0; p < patches.size(); ++p) patches[p].primary = p;
  if (!grid.bonded) return;
  std::sort(primaries.begin(), primaries.end(),
            [&](std::uint32_t x, std::uint32_t y) { return leads(patches[x], patches[y]); });
  grid.by_tile = primaries;
  primaries.clear();
  for (const std::uint32_t p : grid.by_tile) {
    if (primaries.empty() || patches[primaries.back()].tile != patches[p].tile)
      primaries.push_back(p);
    patches[p].primary = primaries.back();
  }
}

}  // namespace

template <int D>
void connect(TileGrid<D>& grid) {
  using T = Tile<D>;
  choose_primaries(grid);
  grid.blocks_known = false;
  std::vector<Patch<D>>& patches = grid.patches;
  const std::vector<std::uint32_t>& primaries = grid.primaries;
  for (auto& p : patches) {
    p.neighbour.fill(-1);
    p.neighbour[T::self] = static_cast<std::int32_t>(&p - patches.data());
  }
  // A list of tiles stays in order when shifted, so a neighbour is found by walking two fingers
  // along the list.
  // Half of the offsets; the other half are the same pairs seen from the other side, k and
  // neighbours - 1 - k being opposite.
  for (int k = T::self + 1; k < T::neighbours; ++k) {
    const Index<D> o = T::offset(k);
    std::size_t finger = 0;
    for (const std::uint32_t p : primaries) {
      Patch<D>& patch = patches[p];
      Index<D> target = patch.tile;
      for (int a = 0; a < D; ++a) target[a] += o[a];
      while (finger < primaries.size() &&
             before<D>(grid, patches[primaries[finger]], patch.body, target))
        // It never goes back: all searches for one offset together are one walk along the list.
        ++finger;
      if (finger == primaries.size()) break;
      Patch<D>& other = patches[primaries[finger]];
      if (other.tile != target || (!grid.bonded && other.body != patch.body)) continue;
      patch.neighbour[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(primaries[finger]);
      other.neighbour[static_cast<std::size_t>(T::neighbours - 1 - k)] =
          static_cast<std::int32_t>(p);
    }
  }
}

template <int D>
bool leaders_are_known(const TileGrid<D>& grid) {
  if (!grid.bonded) return true;
  return std::ranges::is_sorted(grid.by_tile, [&](std::uint32_t x, std::uint32_t y) {
    return leads(grid.patches[x], grid.patches[y]);
  });
}

template <int D>
int find_patch(const TileGrid<D>& grid, int body, const Index<D>& tile) {
  const auto at = std::lower_bound(
      grid.patches.begin(), grid.patches.end(), tile,
      [&](const Patch<D>& p, const Index<D>& t) { return patch_less<D>(p.body, p.tile, body, t); });
  if (at == grid.patches.end() || at->body != body || at->tile != tile) return -1;
  return static_cast<int>(at - grid.patches.begin());
}

template void connect<2>(TileGrid<2>&);
template void connect<3>(TileGrid<3>&);
template bool leaders_are_known<2>(const TileGrid<2>&);
template bool leaders_are_known<3>(const TileGrid<3>&);
template int find_patch<2>(const TileGrid<2>&, int, const Index<2>&);
template int find_patch<3>(const TileGrid<3>&, int, const Index<3>&);

}  // namespace mpm
