#include "mpm/grid/tile_grid.hpp"

#include <algorithm>
#include <numeric>

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

/// In the order of the leaders: by body and tile, or by tile alone where bodies are bonded.
template <int D>
bool TileGrid<D>::before(const Patch<D>& p, int body, const Index<D>& tile) const {
  return bonded ? tile_less<D>(p.tile, tile) : patch_less<D>(p.body, p.tile, body, tile);
}

template <int D>
void TileGrid<D>::choose_leaders() {
  leaders_.resize(patches.size());
  std::iota(leaders_.begin(), leaders_.end(), 0u);
  for (std::uint32_t p = 0; p < patches.size(); ++p) patches[p].leader = p;
  if (!bonded) return;
  std::sort(leaders_.begin(), leaders_.end(), [&](std::uint32_t x, std::uint32_t y) {
    const Patch<D>&p = patches[x], &q = patches[y];
    return p.tile != q.tile ? tile_less<D>(p.tile, q.tile) : p.body < q.body;
  });
  by_tile_ = leaders_;
  leaders_.clear();
  for (const std::uint32_t p : by_tile_) {
    if (leaders_.empty() || patches[leaders_.back()].tile != patches[p].tile) leaders_.push_back(p);
    patches[p].leader = leaders_.back();
  }
}

template <int D>
void TileGrid<D>::connect() {
  using T = Tile<D>;
  choose_leaders();
  for (auto& p : patches) {
    p.neighbour.fill(-1);
    p.neighbour[T::self] = static_cast<std::int32_t>(&p - patches.data());
  }
  // A list of tiles stays in order when shifted, so a neighbour is found by walking two fingers
  // along the list.
  for (int k = T::self + 1; k < T::neighbours; ++k) {
    const Index<D> o = T::offset(k);
    std::size_t finger = 0;
    for (const std::uint32_t p : leaders_) {
      Patch<D>& patch = patches[p];
      Index<D> target = patch.tile;
      for (int a = 0; a < D; ++a) target[a] += o[a];
      while (finger < leaders_.size() && before(patches[leaders_[finger]], patch.body, target))
        ++finger;
      if (finger == leaders_.size()) break;
      Patch<D>& other = patches[leaders_[finger]];
      if (other.tile != target || (!bonded && other.body != patch.body)) continue;
      patch.neighbour[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(leaders_[finger]);
      other.neighbour[static_cast<std::size_t>(T::neighbours - 1 - k)] =
          static_cast<std::int32_t>(p);
    }
  }
  for (auto& p : patches) {
    const bool leads = &patches[p.leader] == &p;
    p.owned = leads ? owned_regions(shape, p) : 0u;
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

/// f(p, leader) for every patch that does not lead, those of one tile one after another.
template <int D>
template <class F>
void TileGrid<D>::for_each_follower(Threads& threads, F&& f) {
  threads.for_each(leaders_.size(), [&](std::size_t k) {
    const std::uint32_t leader = leaders_[k];
    const auto begin = std::lower_bound(by_tile_.begin(), by_tile_.end(), leader,
                                        [&](std::uint32_t x, std::uint32_t y) {
                                          return tile_less<D>(patches[x].tile, patches[y].tile);
                                        });
    for (auto p = begin; p != by_tile_.end() && patches[*p].leader == leader; ++p)
      if (*p != leader) f(*p, leader);
  });
}

template <int D>
void TileGrid<D>::sum_shared_nodes(Threads& threads, int first, int last) {
  const auto fields = static_cast<std::size_t>((last - first) * shape.node_stride);
  const auto start = [&](std::size_t p) { return block(p).data + first * shape.node_stride; };
  if (bonded)
    for_each_follower(threads, [&](std::size_t p, std::size_t leader) {
      double* to = start(leader);
      const double* from = start(p);
      for (std::size_t n = 0; n < fields; ++n) to[n] += from[n];
    });
  // An owner writes only its own entry of a node and reads those of others, which nobody writes in
  // this pass.
  threads.for_each(leaders_.size(), [&](std::size_t leader) {
    const std::size_t p = leaders_[leader];
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
  threads.for_each(leaders_.size(), [&](std::size_t leader) {
    const std::size_t p = leaders_[leader];
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
  if (bonded)
    for_each_follower(threads, [&](std::size_t p, std::size_t leader) {
      std::copy_n(start(leader), fields, start(p));
    });
}

template class TileGrid<2>;
template class TileGrid<3>;

}  // namespace mpm
