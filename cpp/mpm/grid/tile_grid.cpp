#include "mpm/grid/tile_grid.hpp"

#include <algorithm>
#include <numeric>

namespace mpm {

/// In the order of the primaries: by body and tile, or by tile alone where bodies are bonded.
template <int D>
bool TileGrid<D>::before(const Patch<D>& p, int body, const Index<D>& tile) const {
  return bonded ? tile_less<D>(p.tile, tile) : patch_less<D>(p.body, p.tile, body, tile);
}

template <int D>
void TileGrid<D>::choose_primaries() {
  primaries_.resize(patches.size());
  std::iota(primaries_.begin(), primaries_.end(), 0u);
  for (std::uint32_t p = 0; p < patches.size(); ++p) patches[p].primary = p;
  if (!bonded) return;
  std::sort(primaries_.begin(), primaries_.end(), [&](std::uint32_t x, std::uint32_t y) {
    const Patch<D>&p = patches[x], &q = patches[y];
    return p.tile != q.tile ? tile_less<D>(p.tile, q.tile) : p.body < q.body;
  });
  by_tile_ = primaries_;
  primaries_.clear();
  for (const std::uint32_t p : by_tile_) {
    if (primaries_.empty() || patches[primaries_.back()].tile != patches[p].tile)
      primaries_.push_back(p);
    patches[p].primary = primaries_.back();
  }
}

template <int D>
void TileGrid<D>::connect() {
  using T = Tile<D>;
  choose_primaries();
  blocks_known_ = false;
  for (auto& p : patches) {
    p.neighbour.fill(-1);
    p.neighbour[T::self] = static_cast<std::int32_t>(&p - patches.data());
  }
  // A list of tiles stays in order when shifted, so a neighbour is found by walking two fingers
  // along the list.
  for (int k = T::self + 1; k < T::neighbours; ++k) {
    const Index<D> o = T::offset(k);
    std::size_t finger = 0;
    for (const std::uint32_t p : primaries_) {
      Patch<D>& patch = patches[p];
      Index<D> target = patch.tile;
      for (int a = 0; a < D; ++a) target[a] += o[a];
      while (finger < primaries_.size() && before(patches[primaries_[finger]], patch.body, target))
        ++finger;
      if (finger == primaries_.size()) break;
      Patch<D>& other = patches[primaries_[finger]];
      if (other.tile != target || (!bonded && other.body != patch.body)) continue;
      patch.neighbour[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(primaries_[finger]);
      other.neighbour[static_cast<std::size_t>(T::neighbours - 1 - k)] =
          static_cast<std::int32_t>(p);
    }
  }
}

template <int D>
int TileGrid<D>::find(int body, const Index<D>& tile) const {
  const auto at = std::lower_bound(
      patches.begin(), patches.end(), tile,
      [&](const Patch<D>& p, const Index<D>& t) { return patch_less<D>(p.body, p.tile, body, t); });
  if (at == patches.end() || at->body != body || at->tile != tile) return -1;
  return static_cast<int>(at - patches.begin());
}

template <int D>
void TileGrid<D>::exchange(StateStream& stream) {
  stream(cell_size, anchor, walls.cells);
  stream.length(patches, sizeof(Patch<D>::body) + sizeof(Patch<D>::cell_begin));
  for (Patch<D>& p : patches)
    stream(p.body, p.tile, p.begin, p.room, p.count, p.first_row, p.occupied, p.cell_begin,
           p.left_cell);
}

template void TileGrid<2>::connect();
template void TileGrid<3>::connect();
template void TileGrid<2>::exchange(StateStream&);
template void TileGrid<3>::exchange(StateStream&);
template int TileGrid<2>::find(int, const Index<2>&) const;
template int TileGrid<3>::find(int, const Index<3>&) const;

}  // namespace mpm
