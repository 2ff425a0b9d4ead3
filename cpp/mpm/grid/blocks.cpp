// The nodal blocks: which nodes a patch has, which of them it owns, and the sums over the patches
// that share a node.
#include <algorithm>
#include <atomic>

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

/// Nodes that two blocks share, by their numbers in either: listed once, so that the loops over
/// the fields have no branches.
template <int D>
class SharedNodes {
 public:
  /// Those of p and q that a patch owns: p or, if `theirs`, q.
  SharedNodes(const Patch<D>& p, const Patch<D>& q, bool theirs) {
    for_each_shared_row(p, q, [&](int here, int there, int count) {
      const std::uint64_t owned = theirs ? q.owned.row(there, count) : p.owned.row(here, count);
      if (owned == 0) return;
      for (int k = 0; k < count; ++k) {
        here_[count_] = static_cast<std::uint16_t>(here + k);
        there_[count_] = static_cast<std::uint16_t>(there + k);
        count_ += owned >> k & 1u;
      }
    });
  }
  /// f(here, there) for each.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t k = 0; k < count_; ++k) f(here_[k], there_[k]);
  }

 private:
  std::size_t count_ = 0;
  std::array<std::uint16_t, BlockShape<D>::stride_max> here_, there_;
};

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
    needed_ += static_cast<std::size_t>(fields * patch.shape.node_stride);
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
  /// f(to, from) for fields [first, last) of two blocks.
  const auto each_field = [&](const Patch<D>& to, const Patch<D>& from, auto&& f) {
    for (int field = first; field < last; ++field)
      f(node_memory_.data() + to.memory + field * to.shape.node_stride,
        node_memory_.data() + from.memory + field * from.shape.node_stride);
  };
  for_each_follower(threads, [&](const Patch<D>& patch, const Patch<D>& leader) {
    for_each_shared_row(patch, leader, [&](int here, int there, int count) {
      each_field(leader, patch, [&](double* to, const double* from) {
        for (int n = 0; n < count; ++n) to[there + n] += from[here + n];
      });
    });
  });
  // An owner writes only its own entry of a node and reads those of others, which nobody writes in
  // this pass.
  threads.for_each(leaders_.size(), [&](std::size_t leader) {
    const Patch<D>& patch = patches[leaders_[leader]];
    for_each_neighbour(patch, Tile<D>::self + 1, Tile<D>::neighbours, [&](const Patch<D>& later) {
      const SharedNodes<D> mine(patch, later, false);
      each_field(patch, later, [&](double* to, const double* from) {
        mine.for_each([&](int here, int there) { to[here] += from[there]; });
      });
    });
  });
  threads.for_each(leaders_.size(), [&](std::size_t leader) {
    const Patch<D>& patch = patches[leaders_[leader]];
    for_each_neighbour(patch, 0, Tile<D>::self, [&](const Patch<D>& earlier) {
      const SharedNodes<D> theirs(patch, earlier, true);
      each_field(patch, earlier, [&](double* to, const double* from) {
        theirs.for_each([&](int here, int there) { to[here] = from[there]; });
      });
    });
  });
  for_each_follower(threads, [&](const Patch<D>& patch, const Patch<D>& leader) {
    for_each_shared_row(patch, leader, [&](int here, int there, int count) {
      each_field(leader, patch, [&](const double* from, double* to) {
        for (int n = 0; n < count; ++n) to[here + n] = from[there + n];
      });
    });
  });
}

template void TileGrid<2>::cut_blocks(Threads&);
template void TileGrid<3>::cut_blocks(Threads&);
template void TileGrid<2>::sum_shared_nodes(Threads&, int, int);
template void TileGrid<3>::sum_shared_nodes(Threads&, int, int);

}  // namespace mpm
