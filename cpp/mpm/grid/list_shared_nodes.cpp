// Which nodes several patches hold, and who owns them.
#include <algorithm>
#include <bit>
#include <utility>

#include "mpm/grid/shared_nodes.hpp"

namespace mpm {
namespace {

/// The list of one patch, while it is made.
template <int D>
class SharedList {
 public:
  /// Another patch holds a node of this one.
  void add(int node, SharedEntry<D> other) {
    const auto n = static_cast<std::size_t>(node);
    others_[n][count_[n]++] = other;
  }
  /// Count the groups.
  void count(int nodes, SharedNodes<D>& shared) const {
    shared.groups.fill(0);
    for (int n = 0; n < nodes; ++n)
      if (const std::uint8_t others = count_[static_cast<std::size_t>(n)])
        ++shared.groups[others + std::size_t{1}];
  }
  void write(int nodes, const SharedNodes<D>& shared, SharedEntry<D>* to) const {
    std::array<SharedEntry<D>*, SharedNodes<D>::most + 1> next{};
    // By the number of holders, so that the sum over a group has a length that the compiler knows.
    for (std::size_t m = 2; m < next.size(); ++m) {
      next[m] = to;
      to += m * shared.groups[m];
    }
    for (int node = 0; node < nodes; ++node) {
      const auto n = static_cast<std::size_t>(node);
      if (count_[n] == 0) continue;
      SharedEntry<D>*& at = next[count_[n] + std::size_t{1}];
      *at++ = SharedEntry<D>(Tile<D>::self, node);
      at = std::copy_n(others_[n].begin(), count_[n], at);
    }
  }

 private:
  static constexpr std::size_t nodes_max = BlockShape<D>::nodes_max;
  std::array<std::uint8_t, nodes_max> count_{};
  std::array<std::array<SharedEntry<D>, SharedNodes<D>::most - 1>, nodes_max> others_;
};

/// The patches whose own block, or a neighbour's, is another than when their lists were made.
template <int D>
void find_outdated(TileGrid<D>& grid, Threads& threads) {
  grid.shared.outdated.assign(grid.patches.size(), false);
  threads.for_each(grid.primaries.size(), [&](std::size_t primary) {
    const std::uint32_t p = grid.primaries[primary];
    Patch<D>& patch = grid.patches[p];
    // A neighbour's number may change and its block may move: neither is in an entry. Its shape is,
    // and whether it exists (decision 0020).
    std::uint32_t present = 0;
    bool reshaped = false;
    for (std::size_t k = 0; k < Tile<D>::neighbours; ++k)
      if (const std::int32_t q = patch.neighbour[k]; q >= 0) {
        present |= 1u << k;
        reshaped = reshaped || grid.reshaped[static_cast<std::size_t>(q)];
      }
    grid.shared.outdated[p] = reshaped || present != patch.shared.neighbours;
    patch.shared.neighbours = present;
  });
}

template <int D>
void find_owned(const std::vector<Patch<D>>& patches, Patch<D>& patch) {
  // The first patch in the order of the tiles owns: neighbours are numbered in that order, so those
  // before `self` come first. One bit a node, for boxes of any size share any nodes (decision
  // 0013).
  patch.owned.fill(patch.shape.node_count);
  for (int k = 0; k < Tile<D>::self; ++k)
    if (const std::int32_t q = patch.neighbour[static_cast<std::size_t>(k)]; q >= 0)
      for_each_shared_row(patch, patches[static_cast<std::size_t>(q)],
                          [&](int node, int, int count) { patch.owned.clear_row(node, count); });
}

/// The nodes that a patch owns and later neighbours hold too.
template <int D>
SharedList<D> list_of(const std::vector<Patch<D>>& patches, const Patch<D>& patch) {
  SharedList<D> list;
  // Patches that hold one node lie within 2^D tiles, so all others are neighbours of its owner, and
  // come in the order of the tiles, in which sums are taken.
  for (int k = Tile<D>::self + 1; k < Tile<D>::neighbours; ++k) {
    const std::int32_t q = patch.neighbour[static_cast<std::size_t>(k)];
    if (q < 0) continue;
    for_each_shared_row(
        patch, patches[static_cast<std::size_t>(q)], [&](int here, int there, int count) {
          for (std::uint64_t left = patch.owned.row(here, count); left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            list.add(here + i, SharedEntry<D>(k, there + i));
          }
        });
  }
  return list;
}

}  // namespace

template <int D>
void list_shared_nodes(TileGrid<D>& grid, Threads& threads) {
  std::vector<Patch<D>>& patches = grid.patches;
  SharedLists<D>& lists = grid.shared;
  find_outdated(grid, threads);
  const auto each_primary = [&](auto&& f) {
    threads.for_each(grid.primaries.size(),
                     [&](std::size_t k) { f(grid.primaries[k], patches[grid.primaries[k]]); });
  };
  // Made once to be counted and once to be written: few patches need it, and kept it would need
  // more room than all lists.
  each_primary([&](std::uint32_t p, Patch<D>& patch) {
    if (!lists.outdated[p]) return;
    find_owned(patches, patch);
    list_of(patches, patch).count(patch.shape.node_count, patch.shared);
  });
  // What still holds is read where it has been, for which the memory of the nodes lends room.
  const std::span<std::byte> idle = grid.nodes.idle();
  const std::size_t bytes = lists.used * sizeof(SharedEntry<D>);
  if (bytes > idle.size()) make_room(lists.aside, bytes, bytes + bytes / 16);
  auto* const before =
      reinterpret_cast<SharedEntry<D>*>(bytes > idle.size() ? lists.aside.data() : idle.data());
  std::copy_n(lists.entries.data(), lists.used, before);
  lists.used = 0;
  lists.first_before.resize(patches.size());
  for (const std::uint32_t p : grid.primaries) {
    lists.first_before[p] = std::exchange(patches[p].shared.first, lists.used);
    lists.used += patches[p].shared.entries();
  }
  // A sixteenth to spare: lists that creep up must not allocate in every step.
  make_room(lists.entries, lists.used, lists.used + lists.used / 16);
  each_primary([&](std::uint32_t p, const Patch<D>& patch) {
    SharedEntry<D>* const to = lists.entries.data() + patch.shared.first;
    if (lists.outdated[p])
      list_of(patches, patch).write(patch.shape.node_count, patch.shared, to);
    else
      std::copy_n(before + lists.first_before[p], patch.shared.entries(), to);
  });
}

template void list_shared_nodes<2>(TileGrid<2>&, Threads&);
template void list_shared_nodes<3>(TileGrid<3>&, Threads&);

}  // namespace mpm
