// The nodal blocks: which nodes a patch has, which of them it owns, and the sums over the patches
// that share a node.
#include <algorithm>
#include <atomic>
#include <bit>

#include "mpm/grid/tile_grid.hpp"

namespace mpm {
namespace {

template <int D>
bool box_touches_wall(const TileGrid<D>& grid, const Patch<D>& patch) {
  if (!grid.walls.exist || patch.shape.node_count == 0) return false;
  const Index<D> first = grid.first_cell(patch.tile), last = patch.shape.last();
  for (std::size_t a = 0; a < D; ++a) {
    const bool lower = first[a] + patch.shape.low[a] <= 0 && grid.walls.face[a][0] != Wall::free;
    const bool upper =
        first[a] + last[a] >= grid.walls.cells[a] && grid.walls.face[a][1] != Wall::free;
    if (lower || upper) return true;
  }
  return false;
}

/// f(node in p's block, node in q's block, count) for the rows of nodes that both hold.
template <int D, class F>
void for_each_shared_row(const Patch<D>& p, const Patch<D>& q, F&& f) {
  Index<D> low, high, shift;  // as p counts; `shift` to what q counts
  const Index<D> p_last = p.shape.last(), q_last = q.shape.last();
  for (std::size_t a = 0; a < D; ++a) {
    shift[a] = Tile<D>::cells * (p.tile[a] - q.tile[a]);
    low[a] = std::max(p.shape.low[a], q.shape.low[a] - shift[a]);
    high[a] = std::min(p_last[a], q_last[a] - shift[a]);
    if (low[a] > high[a]) return;
  }
  const int p_first = p.shape.node(low), count = high[0] - low[0] + 1;
  Index<D> rows;
  for (std::size_t a = 0; a < D; ++a) {
    rows[a] = high[a] - low[a];
    low[a] += shift[a];
  }
  const int q_first = q.shape.node(low);
  for (int z = 0; z <= (D == 3 ? rows[D - 1] : 0); ++z)
    for (int y = 0; y <= rows[1]; ++y)
      f(p_first + (z * p.shape.nodes[1] + y) * p.shape.nodes[0],
        q_first + (z * q.shape.nodes[1] + y) * q.shape.nodes[0], count);
}

}  // namespace

/// Find the shapes of the blocks; false if none has changed.
template <int D>
bool TileGrid<D>::find_shapes(Threads& threads) {
  std::atomic<bool> changed = bonded;
  threads.for_each(patches.size(), [&](std::size_t p) {
    const auto shape = BlockShape<D>::around(patches[p].occupied, margin());
    if (patches[p].shape == shape) return;
    patches[p].shape = shape;
    changed.store(true, std::memory_order_relaxed);
  });
  if (bonded)
    for (const std::uint32_t p : by_tile_) {
      BlockShape<D>& all = patches[patches[p].leader].shape;
      all = all.joined_with(patches[p].shape);
    }
  return changed;
}

template <int D>
void TileGrid<D>::cut_blocks(Threads& threads) {
  if (!find_shapes(threads) && blocks_known_) return;
  blocks_known_ = true;
  needed_ = 0;
  for (Patch<D>& patch : patches) {
    patch.memory = needed_;
    needed_ += static_cast<std::size_t>(line_width * patch.shape.node_count);
  }
  make_room(node_memory_, needed_, needed_ + needed_ / 16);
  threads.for_each(patches.size(), [&](std::size_t p) {
    Patch<D>& patch = patches[p];
    patch.at_wall = box_touches_wall(*this, patch);
    patch.owned.fill(patch.leader == p ? patch.shape.node_count : 0);
    if (patch.leader != p) return;
    for_each_neighbour(patch, 0, Tile<D>::self, [&](const Patch<D>& earlier) {
      for_each_shared_row(patch, earlier,
                          [&](int node, int, int count) { patch.owned.clear_row(node, count); });
    });
  });
}

/// f(p, leader) for every patch that does not lead, those of one tile one after another.
template <int D>
template <class F>
void TileGrid<D>::for_each_follower(Threads& threads, F&& f) {
  if (!bonded) return;
  threads.for_each(leaders_.size(), [&](std::size_t k) {
    const std::uint32_t leader = leaders_[k];
    const auto begin = std::lower_bound(by_tile_.begin(), by_tile_.end(), leader,
                                        [&](std::uint32_t x, std::uint32_t y) {
                                          return tile_less<D>(patches[x].tile, patches[y].tile);
                                        });
    for (auto p = begin; p != by_tile_.end() && patches[*p].leader == leader; ++p)
      if (*p != leader) f(patches[*p], patches[leader]);
  });
}

/// f(neighbour) for the neighbours of a patch by number from `first` to before `last`.
template <int D>
template <class F>
void TileGrid<D>::for_each_neighbour(const Patch<D>& patch, int first, int last, F&& f) {
  for (int k = first; k < last; ++k)
    if (const std::int32_t q = patch.neighbour[static_cast<std::size_t>(k)]; q >= 0)
      f(patches[static_cast<std::size_t>(q)]);
}

template <int D>
void TileGrid<D>::sum_shared_nodes(Threads& threads, int first, int last) {
  // Numbers [first, last) of two lines; only `to` is written.
  const auto add = [&](double* to, const double* from) {
    for (int k = first; k < last; k += quad)
      (Batch<quad>::load(to + k) + Batch<quad>::load(from + k)).store(to + k);
  };
  const auto copy = [&](double* to, const double* from) {
    for (int k = first; k < last; k += quad) Batch<quad>::load(from + k).store(to + k);
  };
  /// f(p's line, q's line) for the nodes that both hold, or those of them that a patch owns.
  const auto each_node = [&](const Patch<D>& p, const Patch<D>& q, const Patch<D>* owner,
                             auto&& f) {
    const NodeLines p_lines = lines_of(p), q_lines = lines_of(q);
    for_each_shared_row(p, q, [&](int here, int there, int count) {
      std::uint64_t left = low_bits(count);
      if (owner) left = owner->owned.row(owner == &p ? here : there, count);
      for (; left != 0; left &= left - 1) {
        const int k = std::countr_zero(left);
        f(p_lines[here + k], q_lines[there + k]);
      }
    });
  };
  /// f(patch, neighbour) for the leaders and their neighbours from `begin` to before `end`; the
  /// memory is told of the next leader's nodes, which lie all over it, in time.
  const auto each_neighbour = [&](int begin, int end, auto&& f) {
    threads.for_each(leaders_.size(), [&](std::size_t leader) {
      if (leader + 1 < leaders_.size()) {
        const Patch<D>& next = patches[leaders_[leader + 1]];
        for_each_neighbour(next, begin, end, [&](const Patch<D>& other) {
          each_node(next, other, nullptr, [](const double* here, const double* there) {
            __builtin_prefetch(here);
            __builtin_prefetch(there);
          });
        });
      }
      const Patch<D>& patch = patches[leaders_[leader]];
      for_each_neighbour(patch, begin, end, [&](const Patch<D>& other) { f(patch, other); });
    });
  };
  for_each_follower(threads, [&](const Patch<D>& patch, const Patch<D>& leader) {
    each_node(leader, patch, nullptr, add);
  });
  // An owner writes only its own entry of a node and reads those of others, which nobody writes in
  // this pass.
  each_neighbour(
      Tile<D>::self + 1, Tile<D>::neighbours,
      [&](const Patch<D>& patch, const Patch<D>& later) { each_node(patch, later, &patch, add); });
  each_neighbour(0, Tile<D>::self, [&](const Patch<D>& patch, const Patch<D>& earlier) {
    each_node(patch, earlier, &earlier, copy);
  });
  for_each_follower(threads, [&](const Patch<D>& patch, const Patch<D>& leader) {
    each_node(patch, leader, nullptr, copy);
  });
}

template void TileGrid<2>::cut_blocks(Threads&);
template void TileGrid<3>::cut_blocks(Threads&);
template void TileGrid<2>::sum_shared_nodes(Threads&, int, int);
template void TileGrid<3>::sum_shared_nodes(Threads&, int, int);

}  // namespace mpm
