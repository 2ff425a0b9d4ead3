#include <algorithm>
#include <limits>

#include "mpm/particles/cell_lists.hpp"

namespace mpm {
namespace {

/// Where the rows of a body lie, the lowest first. They are those of its lists in another order.
struct SortedRows {
  std::uint32_t first = 0;
  bool in_sequence = true;  // else some were removed, or rows lie where others do
  std::span<std::uint32_t> rows{};

  std::uint32_t operator[](std::size_t k) const {
    return in_sequence ? first + static_cast<std::uint32_t>(k) : rows[k];
  }
  template <int D>
  SortedRows(const ParticlePool<D>& pool, std::span<const Patch<D>> patches, std::size_t count) {
    first = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t last = 0;
    for (const Patch<D>& patch : patches)
      for (const std::uint32_t row : pool.rows(patch)) {
        first = std::min(first, row);
        last = std::max(last, row);
      }
    // As many rows as numbers from the least to the greatest, and none twice: then no list of them
    // is needed.
    in_sequence = count == 0 || last - first + std::size_t{1} == count;
  }
  template <int D>
  void fill(const ParticlePool<D>& pool, std::span<const Patch<D>> patches,
            std::span<std::uint32_t> room) {
    rows = room;
    auto to = rows.begin();
    for (const Patch<D>& patch : patches) to = std::ranges::copy(pool.rows(patch), to).out;
    // The body's rows are exchanged among themselves; those of other bodies may lie between.
    std::ranges::sort(rows);
  }
};

}  // namespace

template <int D>
void sort_columns(TileGrid<D>& grid, Body<D>& body, std::span<Patch<D>> patches,
                  ParticlePool<D>& pool, Threads& threads, ListScratch<D>& scratch) {
  // Changes are counted anew from here.
  body.moved = 0;
  std::size_t n = 0;
  for (const Patch<D>& patch : patches) n += patch.count;
  const std::span<const Patch<D>> lists = patches;
  SortedRows rows(pool, lists, n);
  // One component at a time in the idle memory of the nodes: 8 bytes a particle, however many
  // columns.
  const std::size_t each = sizeof(double) + (rows.in_sequence ? 0 : sizeof(std::uint32_t));
  std::byte* const room = scratch.room(grid, n * each, n * each);
  if (!rows.in_sequence)
    rows.fill(pool, lists, {reinterpret_cast<std::uint32_t*>(room + n * sizeof(double)), n});
  auto& first = scratch.first;
  first.resize(patches.size());
  std::uint32_t next = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    first[p] = next;
    next += patches[p].count;
  }
  const auto sort = [&]<class Number>(Number* values) {
    auto* const sorted = reinterpret_cast<Number*>(room);
    threads.for_each(patches.size(), [&](std::size_t p) {
      Number* const to = sorted + first[p];
      const std::span<const std::uint32_t> list = pool.rows(patches[p]);
      for (std::size_t k = 0; k < list.size(); ++k) to[k] = values[list[k]];
    });
    // A pass of its own: a patch's new rows are those that other patches read in the first.
    threads.for_each(patches.size(), [&](std::size_t p) {
      const std::size_t begin = first[p], end = begin + patches[p].count;
      if (rows.in_sequence)
        std::copy(sorted + begin, sorted + end, values + rows.first + begin);
      else
        for (std::size_t k = begin; k < end; ++k) values[rows.rows[k]] = sorted[k];
    });
  };
  // Moved, not computed: no result can tell that columns were sorted (decision 0033).
  for (int c = 0; c < pool.columns.component_count(); ++c) pool.columns.with_component(c, sort);
  sort(pool.id.data());
  if (!pool.piece.empty()) sort(pool.piece.data());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].first_row = patches[p].count > 0 ? rows[first[p]] : 0;
    for (std::size_t k = 0; k < patches[p].count; ++k)
      pool.order[patches[p].begin + k] = rows[first[p] + k];
  }
}

template <int D>
void sort_disordered(TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                     std::vector<ParticlePool<D>>& pools, Threads& threads, double share,
                     ListScratch<D>& scratch) {
  for (const int number : scratch.moved) {
    Body<D>& body = bodies[static_cast<std::size_t>(number)];
    const auto patches = patches_of<D>(grid.patches, number);
    std::size_t here = 0;
    for (const Patch<D>& patch : patches) here += patch.count;
    // A quarter by default: a compromise between rows loaded one by one and the cost of sorting
    // (decision 0002).
    if (static_cast<double>(body.moved) >= share * static_cast<double>(here))
      sort_columns(grid, body, patches, pools[static_cast<std::size_t>(body.material)], threads,
                   scratch);
  }
}

template void sort_columns<2>(TileGrid<2>&, Body<2>&, std::span<Patch<2>>, ParticlePool<2>&,
                              Threads&, ListScratch<2>&);
template void sort_columns<3>(TileGrid<3>&, Body<3>&, std::span<Patch<3>>, ParticlePool<3>&,
                              Threads&, ListScratch<3>&);
template void sort_disordered<2>(TileGrid<2>&, std::vector<Body<2>>&, std::vector<ParticlePool<2>>&,
                                 Threads&, double, ListScratch<2>&);
template void sort_disordered<3>(TileGrid<3>&, std::vector<Body<3>>&, std::vector<ParticlePool<3>>&,
                                 Threads&, double, ListScratch<3>&);

}  // namespace mpm
