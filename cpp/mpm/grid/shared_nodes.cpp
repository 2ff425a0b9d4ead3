// The nodes that several patches hold: who owns them, the lists of them, and the sums.
#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "mpm/grid/tile_grid.hpp"

namespace mpm {
namespace {

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

/// f(node, where a later neighbour has it) for the nodes that a patch owns.
template <int D>
template <class F>
void TileGrid<D>::for_each_shared(const Patch<D>& patch, F&& f) const {
  for (int k = Tile<D>::self + 1; k < Tile<D>::neighbours; ++k) {
    const std::int32_t q = patch.neighbour[static_cast<std::size_t>(k)];
    if (q < 0) continue;
    for_each_shared_row(
        patch, patches[static_cast<std::size_t>(q)], [&](int here, int there, int count) {
          for (std::uint64_t left = patch.owned.row(here, count); left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            f(here + i, SharedEntry<D>(k, there + i));
          }
        });
  }
}

/// The patches whose own block, or a neighbour's, is another than when their lists were made.
template <int D>
void TileGrid<D>::find_outdated(Threads& threads) {
  outdated_.assign(patches.size(), false);
  threads.for_each(primaries_.size(), [&](std::size_t primary) {
    const std::uint32_t p = primaries_[primary];
    std::uint32_t present = 0;
    bool reshaped = false;
    for (std::size_t k = 0; k < Tile<D>::neighbours; ++k)
      if (const std::int32_t q = patches[p].neighbour[k]; q >= 0) {
        present |= 1u << k;
        reshaped = reshaped || reshaped_[static_cast<std::size_t>(q)];
      }
    outdated_[p] = reshaped || present != patches[p].shared.neighbours;
    patches[p].shared.neighbours = present;
  });
}

template <int D>
void TileGrid<D>::find_owned(Patch<D>& patch) const {
  patch.owned.fill(patch.shape.node_count);
  for (int k = 0; k < Tile<D>::self; ++k)
    if (const std::int32_t q = patch.neighbour[static_cast<std::size_t>(k)]; q >= 0)
      for_each_shared_row(patch, patches[static_cast<std::size_t>(q)],
                          [&](int node, int, int count) { patch.owned.clear_row(node, count); });
}

/// Owners and lists of shared nodes, made anew for those patches where they have changed.
template <int D>
void TileGrid<D>::list_shared_nodes(Threads& threads) {
  find_outdated(threads);
  const auto each_primary = [&](auto&& f) {
    threads.for_each(primaries_.size(),
                     [&](std::size_t k) { f(primaries_[k], patches[primaries_[k]]); });
  };
  // Made once to be counted and once to be written: few patches need it, and kept it would need
  // more room than all lists.
  const auto list_of = [&](const Patch<D>& patch) {
    SharedList<D> list;
    for_each_shared(patch, [&](int node, SharedEntry<D> other) { list.add(node, other); });
    return list;
  };
  each_primary([&](std::uint32_t p, Patch<D>& patch) {
    if (!outdated_[p]) return;
    find_owned(patch);
    list_of(patch).count(patch.shape.node_count, patch.shared);
  });
  // What still holds is read where it has been, for which the memory of the nodes lends room.
  // There is: an entry has two bytes, the line of its node 64.
  assert(listed_ * sizeof(SharedEntry<D>) <= idle_memory().size());
  auto* const before = reinterpret_cast<SharedEntry<D>*>(idle_memory().data());
  std::copy_n(shared_.data(), listed_, before);
  listed_ = 0;
  listed_before_.resize(patches.size());
  for (const std::uint32_t p : primaries_) {
    listed_before_[p] = std::exchange(patches[p].shared.first, listed_);
    listed_ += patches[p].shared.entries();
  }
  make_room(shared_, listed_, listed_ + listed_ / 16);
  each_primary([&](std::uint32_t p, const Patch<D>& patch) {
    SharedEntry<D>* const to = shared_.data() + patch.shared.first;
    if (outdated_[p])
      list_of(patch).write(patch.shape.node_count, patch.shared, to);
    else
      std::copy_n(before + listed_before_[p], patch.shared.entries(), to);
  });
}

/// f(p, primary) for every secondary patch, those of one tile one after another.
template <int D>
template <class F>
void TileGrid<D>::for_each_secondary(Threads& threads, F&& f) {
  if (!bonded) return;
  threads.for_each(primaries_.size(), [&](std::size_t k) {
    const std::uint32_t primary = primaries_[k];
    const auto begin = std::lower_bound(by_tile_.begin(), by_tile_.end(), primary,
                                        [&](std::uint32_t x, std::uint32_t y) {
                                          return tile_less<D>(patches[x].tile, patches[y].tile);
                                        });
    for (auto p = begin; p != by_tile_.end() && patches[*p].primary == primary; ++p)
      if (*p != primary) f(patches[*p], patches[primary]);
  });
}

/// Of the nodes that a patch owns and others hold too.
template <int D>
template <int halves, int width, class F>
void TileGrid<D>::sum_shared_nodes_of(const Patch<D>& patch, F&& begin_of) {
  std::array<Nodes<width>, Tile<D>::neighbours> block{};
  for (std::size_t k = Tile<D>::self; k < Tile<D>::neighbours; ++k)
    if (patch.neighbour[k] >= 0)
      block[k].data = begin_of(patches[static_cast<std::size_t>(patch.neighbour[k])]);
  const SharedEntry<D>* entry = shared_.data() + patch.shared.first;
  unrolled<SharedNodes<D>::most - 1>([&](auto m) {
    constexpr int holders = m + 2;
    for (int left = patch.shared.groups[holders]; left > 0; --left, entry += holders) {
      double* numbers[holders];
      for (int h = 0; h < holders; ++h) numbers[h] = block[entry[h].neighbour][entry[h].node];
      unrolled<halves>([&](auto q) {
        auto sum = Batch<half_record>::load(numbers[0] + q * half_record);
        for (int h = 1; h < holders; ++h)
          sum += Batch<half_record>::load(numbers[h] + q * half_record);
        for (int h = 0; h < holders; ++h) sum.store(numbers[h] + q * half_record);
      });
    }
  });
}

template <int D>
template <int halves, int width, class F>
void TileGrid<D>::sum_shared(Threads& threads, F&& begin_of) {
  /// f(p's half record, q's) for the nodes that both hold.
  const auto each_quad = [&](const Patch<D>& p, const Patch<D>& q, auto&& f) {
    const Nodes<width> of_p{begin_of(p)}, of_q{begin_of(q)};
    for_each_shared_row(p, q, [&](int here, int there, int count) {
      for (int i = 0; i < count; ++i)
        for (int k = 0; k < halves * half_record; k += half_record)
          f(of_p[here + i] + k, of_q[there + i] + k);
    });
  };
  for_each_secondary(threads, [&](const Patch<D>& patch, const Patch<D>& primary) {
    each_quad(primary, patch, [](double* to, const double* from) {
      (Batch<half_record>::load(to) + Batch<half_record>::load(from)).store(to);
    });
  });
  // All entries of a node are read and written by the one patch that owns it.
  threads.for_each(primaries_.size(), [&](std::size_t k) {
    sum_shared_nodes_of<halves, width>(patches[primaries_[k]], begin_of);
  });
  for_each_secondary(threads, [&](const Patch<D>& patch, const Patch<D>& primary) {
    each_quad(patch, primary,
              [](double* to, const double* from) { Batch<half_record>::load(from).store(to); });
  });
}

template <int D>
void TileGrid<D>::sum_shared_nodes(Threads& threads, int first, int last) {
  const auto begin_of = [&](const Patch<D>& p) { return block_of(p).records.data + first; };
  if (last - first == record)
    sum_shared<2, record>(threads, begin_of);
  else
    sum_shared<1, record>(threads, begin_of);
}

template <int D>
void TileGrid<D>::sum_shared_dashpots(Threads& threads) {
  sum_shared<1, half_record>(threads,
                             [&](const Patch<D>& p) { return block_of(p).dashpots().data; });
}

template void TileGrid<2>::list_shared_nodes(Threads&);
template void TileGrid<3>::list_shared_nodes(Threads&);
template void TileGrid<2>::sum_shared_nodes(Threads&, int, int);
template void TileGrid<3>::sum_shared_nodes(Threads&, int, int);
template void TileGrid<2>::sum_shared_dashpots(Threads&);
template void TileGrid<3>::sum_shared_dashpots(Threads&);

}  // namespace mpm
