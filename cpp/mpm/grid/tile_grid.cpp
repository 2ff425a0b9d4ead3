#include "mpm/grid/tile_grid.hpp"

#include <algorithm>

namespace mpm {
namespace {

template <int D>
bool box_touches_wall(const TileGrid<D>& grid, const Patch<D>& patch) {
  if (!grid.walls.exist) return false;
  const Index<D> first = grid.first_cell(patch.tile);
  const int margin = grid.shape.margin;
  for (int a = 0; a < D; ++a) {
    const bool lower = first[a] - margin <= 0 && grid.walls.face[a][0] != Wall::free;
    const bool upper = first[a] + Tile<D>::cells + margin >= grid.walls.cells[a] &&
                       grid.walls.face[a][1] != Wall::free;
    if (lower || upper) return true;
  }
  return false;
}

template <int D>
std::uint32_t owned_regions(const BlockShape<D>& shape, const Patch<D>& patch) {
  std::uint32_t owned = 0;
  for (std::size_t r = 0; r < shape.regions.size(); ++r) {
    bool first = true;  // the first of the sharers in the order of the tiles owns a node
    for (const int k : shape.regions[r].sharers)
      first = first && !(k < Tile<D>::self && patch.neighbour[static_cast<std::size_t>(k)] >= 0);
    owned |= first ? 1u << r : 0u;
  }
  return owned;
}

}  // namespace

template <int D>
void TileGrid<D>::connect() {
  using T = Tile<D>;
  for (auto& p : patches) {
    p.neighbour.fill(-1);
    p.neighbour[T::self] = static_cast<std::int32_t>(&p - patches.data());
  }
  // A list of tiles stays in order when shifted, so a neighbour is found by walking two fingers
  // along the list.
  for (int k = T::self + 1; k < T::neighbours; ++k) {
    const Index<D> o = T::offset(k);
    std::size_t q = 0;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      Index<D> target = patches[p].tile;
      for (int a = 0; a < D; ++a) target[a] += o[a];
      while (q < patches.size() &&
             patch_less<D>(patches[q].body, patches[q].tile, patches[p].body, target))
        ++q;
      if (q == patches.size()) break;
      if (patches[q].body != patches[p].body || patches[q].tile != target) continue;
      patches[p].neighbour[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(q);
      patches[q].neighbour[static_cast<std::size_t>(T::neighbours - 1 - k)] =
          static_cast<std::int32_t>(p);
    }
  }
  for (auto& p : patches) {
    p.owned = owned_regions(shape, p);
    p.at_wall = box_touches_wall(*this, p);
  }
  const std::size_t needed = patches.size() * block_size();
  if (needed > node_memory_.size()) node_memory_.release_and_allocate(needed + needed / 8);
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
void TileGrid<D>::sum_shared_nodes(Threads& threads, int first, int last) {
  // An owner writes only its own entry of a node and reads those of others, which nobody writes in
  // this pass.
  threads.for_each(patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = patches[p];
    for (std::size_t r = 0; r < shape.regions.size(); ++r) {
      if (!(patch.owned >> r & 1u)) continue;
      const Region& region = shape.regions[r];
      for (const int s : region.sharers) {
        const auto k = static_cast<std::size_t>(s);
        if (patch.neighbour[k] < 0) continue;
        const double* other =
            block(static_cast<std::size_t>(patch.neighbour[k])).data + shape.shift[k];
        for (int f = first; f < last; ++f) {
          double* to = block(p).data + f * shape.node_stride;
          const double* from = other + f * shape.node_stride;
          for (const int n : region.nodes) to[n] += from[n];
        }
      }
    }
  });
  threads.for_each(patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = patches[p];
    for (std::size_t r = 0; r < shape.regions.size(); ++r) {
      if (patch.owned >> r & 1u) continue;
      const Region& region = shape.regions[r];
      const auto owner = std::find_if(region.sharers.begin(), region.sharers.end(), [&](int s) {
        return patch.neighbour[static_cast<std::size_t>(s)] >= 0;
      });
      const auto k = static_cast<std::size_t>(*owner);
      const double* other =
          block(static_cast<std::size_t>(patch.neighbour[k])).data + shape.shift[k];
      for (int f = first; f < last; ++f) {
        double* to = block(p).data + f * shape.node_stride;
        const double* from = other + f * shape.node_stride;
        for (const int n : region.nodes) to[n] = from[n];
      }
    }
  });
}

template class TileGrid<2>;
template class TileGrid<3>;

}  // namespace mpm
