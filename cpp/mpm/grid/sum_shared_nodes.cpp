// The sums over the patches that hold a node, in an order that no number of threads changes.
#include <algorithm>

#include "mpm/grid/shared_nodes.hpp"

namespace mpm {
namespace {

/// f(p, primary) for every secondary patch, those of one tile one after another.
template <int D, class F>
void for_each_secondary(TileGrid<D>& grid, Threads& threads, F&& f) {
  if (!grid.bonded) return;
  std::vector<Patch<D>>& patches = grid.patches;
  threads.for_each(grid.primaries.size(), [&](std::size_t k) {
    // Those of one tile by one thread: they all add to the same primary.
    const std::uint32_t primary = grid.primaries[k];
    const auto begin = std::lower_bound(grid.by_tile.begin(), grid.by_tile.end(), primary,
                                        [&](std::uint32_t x, std::uint32_t y) {
                                          return tile_less<D>(patches[x].tile, patches[y].tile);
                                        });
    for (auto p = begin; p != grid.by_tile.end() && patches[*p].primary == primary; ++p)
      if (*p != primary) f(patches[*p], patches[primary]);
  });
}

/// The sums of the nodes that a patch owns and others hold too.
///
/// `begin_of(patch)`: the first of the numbers of its nodes that are summed, so many halves.
template <int halves, int width, int D, class F>
void sum_nodes_of(TileGrid<D>& grid, const Patch<D>& patch, F&& begin_of) {
  std::array<Nodes<width>, Tile<D>::neighbours> block{};
  for (std::size_t k = Tile<D>::self; k < Tile<D>::neighbours; ++k)
    if (patch.neighbour[k] >= 0)
      block[k].data = begin_of(grid.patches[static_cast<std::size_t>(patch.neighbour[k])]);
  const SharedEntry<D>* entry = grid.shared.entries.data() + patch.shared.first;
  unrolled<SharedNodes<D>::most - 1>([&](auto m) {
    constexpr int holders = m + 2;
    for (int left = patch.shared.groups[holders]; left > 0; --left, entry += holders) {
      double* numbers[holders];
      for (int h = 0; h < holders; ++h) numbers[h] = block[entry[h].neighbour][entry[h].node];
      // All patches that hold a node near a wall are at it.
      if constexpr (width == wall_record)
        if (std::ranges::any_of(entry, entry + holders, [&](const SharedEntry<D>& one) {
              return block[one.neighbour].data == nullptr;
            }))
          continue;
      unrolled<halves>([&](auto q) {
        // The owner's first, then the others' in the order of the tiles: bits that no thread count
        // changes. Four numbers of a record at once, the unused one with them.
        auto sum = Batch<half_record>::load(numbers[0] + q * half_record);
        for (int h = 1; h < holders; ++h)
          sum += Batch<half_record>::load(numbers[h] + q * half_record);
        // At once to all holders: no second pass, and no patch reads what another writes (decision
        // 0020).
        for (int h = 0; h < holders; ++h) sum.store(numbers[h] + q * half_record);
      });
    }
  });
}

template <int halves, int width, int D, class F, class Keeping>
void sum_shared(TileGrid<D>& grid, Threads& threads, F&& begin_of, Keeping&& sum_keeping) {
  /// f(p's half record, q's) for the nodes that both hold.
  const auto each_quad = [&](const Patch<D>& p, const Patch<D>& q, auto&& f) {
    const Nodes<width> of_p{begin_of(p)}, of_q{begin_of(q)};
    if (of_p.data == nullptr || of_q.data == nullptr) return;
    for_each_shared_row(p, q, [&](int here, int there, int count) {
      for (int i = 0; i < count; ++i)
        for (int k = 0; k < halves * half_record; k += half_record)
          f(of_p[here + i] + k, of_q[there + i] + k);
    });
  };
  // Bonded bodies first into the first patch of their tile, then across tiles, then back to all:
  // the sum is that of one body of several materials.
  for_each_secondary(grid, threads, [&](const Patch<D>& patch, const Patch<D>& primary) {
    each_quad(primary, patch, [](double* to, const double* from) {
      (Batch<half_record>::load(to) + Batch<half_record>::load(from)).store(to);
    });
  });
  // All entries of a node are read and written by the one patch that owns it.
  threads.for_each(grid.primaries.size(), [&](std::size_t k) {
    const Patch<D>& patch = grid.patches[grid.primaries[k]];
    if (patch.keeps)
      sum_keeping(patch);
    else
      sum_nodes_of<halves, width>(grid, patch, begin_of);
  });
  for_each_secondary(grid, threads, [&](const Patch<D>& patch, const Patch<D>& primary) {
    each_quad(patch, primary,
              [](double* to, const double* from) { Batch<half_record>::load(from).store(to); });
  });
}

}  // namespace

template <int D>
void sum_shared_nodes(TileGrid<D>& grid, Threads& threads, int first, int last, bool kept) {
  const auto from = [&](int number) {
    return [&grid, number](const Patch<D>& p) { return grid.block(p).records.data + number; };
  };
  const auto keeping = [&](const Patch<D>& patch) {
    if (kept) sum_nodes_of<1, record>(grid, patch, from(last - half_record));
  };
  if (last - first == record)
    sum_shared<2, record>(grid, threads, from(first), keeping);
  else
    sum_shared<1, record>(grid, threads, from(first), keeping);
}

template <int D>
void sum_kept_number(TileGrid<D>& grid, Threads& threads, int number) {
  threads.for_each(grid.primaries.size(), [&](std::size_t k) {
    const Patch<D>& patch = grid.patches[grid.primaries[k]];
    if (!patch.keeps) return;
    const auto at = [&](const SharedEntry<D>& one) -> double& {
      const std::int32_t q = patch.neighbour[one.neighbour];
      return grid.block(static_cast<std::size_t>(q)).displacements[one.node][number];
    };
    std::span left(grid.shared.entries.data() + patch.shared.first, patch.shared.entries());
    for (std::size_t holders = 2; holders <= SharedNodes<D>::most; ++holders)
      for (int m = patch.shared.groups[holders]; m > 0; --m, left = left.subspan(holders)) {
        const auto all = left.first(holders);
        double sum = 0.0;
        for (const SharedEntry<D>& one : all) sum += at(one);
        for (const SharedEntry<D>& one : all) at(one) = sum;
      }
  });
}

template <int D>
void sum_shared_at_walls(TileGrid<D>& grid, Threads& threads) {
  const auto none = [](const Patch<D>&) {};
  if (grid.has_dashpots)
    sum_shared<1, half_record>(
        grid, threads, [&](const Patch<D>& p) { return grid.block(p).dashpots().data; }, none);
  if (grid.has_wall_springs)
    sum_shared<3, wall_record>(
        grid, threads, [&](const Patch<D>& p) { return grid.block(p).springs.data; }, none);
}

template void sum_shared_nodes<2>(TileGrid<2>&, Threads&, int, int, bool);
template void sum_shared_nodes<3>(TileGrid<3>&, Threads&, int, int, bool);
template void sum_shared_at_walls<2>(TileGrid<2>&, Threads&);
template void sum_shared_at_walls<3>(TileGrid<3>&, Threads&);
template void sum_kept_number<2>(TileGrid<2>&, Threads&, int);
template void sum_kept_number<3>(TileGrid<3>&, Threads&, int);

}  // namespace mpm
