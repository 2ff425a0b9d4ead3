#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>

#include "mpm/particles/classify.hpp"
#include "mpm/particles/lists.hpp"

namespace mpm {
namespace {

/// Note the cells of a patch's particles, and how many go where.
template <int D>
typename ListScratch<D>::Note note_changes(const TileGrid<D>& grid, const Body<D>& body,
                                           const Patch<D>& patch, ListScratch<D>& scratch) {
  typename ListScratch<D>::Note note{patch.count};
  if (!patch.left_cell) return note;
  std::uint8_t* const cells = scratch.cell_of(patch.body);
  note.changes = static_cast<std::uint32_t>(note_cells(grid, body, patch, cells) +
                                            note_gone(grid, body, patch, cells));
  const std::span<const std::uint8_t> now(cells + patch.begin, patch.count);
  note.leavers = static_cast<std::uint32_t>(std::ranges::count(now, CellMark::outside));
  note.kept -= static_cast<std::uint32_t>(
      std::ranges::count_if(now, [](std::uint8_t c) { return c >= CellMark::left; }));
  return note;
}

/// Write a patch's new list: the particles it keeps and those that come, by cell, then by id: sums
/// over the particles of a cell must not depend on where their rows are.
template <int D>
void write_list(const Body<D>& body, Patch<D>& patch, const typename ListScratch<D>::Change& change,
                ListScratch<D>& scratch) {
  std::uint32_t* to = scratch.order_of(patch.body) + change.begin;
  std::uint8_t* cell = scratch.cell_of(patch.body);
  const std::span<const Arrival> arrivals(scratch.arrivals.data() + change.first_arrival,
                                          scratch.arrivals.data() + change.arrivals_end);
  if (!patch.left_cell && arrivals.empty()) {
    std::memcpy(to, body.order.data() + patch.begin, patch.count * sizeof(std::uint32_t));
    patch.begin = change.begin;
    return;
  }
  if (!patch.left_cell)
    patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
      std::memset(cell + begin, c, end - begin);
    });
  constexpr int cells = Tile<D>::cell_count;
  std::array<std::uint32_t, cells + 1> begin{};
  for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
    if (cell[k] < CellMark::left) ++begin[cell[k] + std::size_t{1}];
  for (const Arrival& arrival : arrivals) ++begin[arrival.cell + std::size_t{1}];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  auto next = begin;
  auto put = [&](std::uint8_t c, std::uint32_t row) {
    std::uint32_t at = next[c]++;
    for (; at > begin[c] && body.id[to[at - 1]] > body.id[row]; --at) to[at] = to[at - 1];
    to[at] = row;
  };
  for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
    if (cell[k] < CellMark::left) put(cell[k], body.order[k]);
  for (const Arrival& arrival : arrivals) put(arrival.cell, arrival.row);

  patch.begin = change.begin;
  patch.count = begin[cells];
  patch.cell_begin = begin;
  patch.occupied = 0;
  for (int c = 0; c < cells; ++c)
    if (begin[static_cast<std::size_t>(c) + 1] > begin[static_cast<std::size_t>(c)])
      patch.occupied |= std::uint64_t{1} << c;
  patch.left_cell = false;
}

/// Take what a particle has out of the sums of those that take part.
template <int D>
void take_out(const Body<D>& body, std::uint32_t row, Gone<D>& sums) {
  const double m = body.mass()[row];
  ++sums.count;
  sums.mass += m;
  for (int a = 0; a < D; ++a) {
    const double v = body.v(a)[row];
    sums.kinetic += 0.5 * m * v * v;
    sums.momentum[a] += m * v;
  }
  const double energy = body.columns.component(body.at.recoverable)[row];
  sums.recoverable += energy * m / body.initial_density;
}

/// The end of a body's new list, behind all patches: what goes now, then what has gone before.
template <int D>
void write_tail(std::span<const Patch<D>> patches, Body<D>& body, const std::uint8_t* cell,
                std::uint32_t* order, Gone<D>& eroded_sums, Gone<D>& left_sums) {
  const std::size_t before = body.gone, n = body.count();
  std::size_t now = 0;
  const auto each = [&](auto&& f) {
    for (const Patch<D>& patch : patches) {
      if (!patch.left_cell) continue;
      for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
        if (cell[k] == CellMark::eroded || cell[k] == CellMark::left)
          f(body.order[k], cell[k] == CellMark::left);
    }
  };
  each([&](std::uint32_t, bool) { ++now; });
  if (before + now == 0) return;
  std::uint32_t* to = order + (n - before - now);
  each([&](std::uint32_t row, bool leaves) {
    take_out(body, row, leaves ? left_sums : eroded_sums);
    if (leaves) body.columns.component(body.at.failed)[row] = left_region;
    *to++ = row;
  });
  std::memcpy(to, body.order.data() + (n - before), before * sizeof(std::uint32_t));
  body.gone = before + now;
}

/// Room for the lists of the bodies whose particles have left their cells; false if there are none.
template <int D>
bool find_lists(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, ListScratch<D>& scratch) {
  scratch.first.assign(bodies.size(), scratch.none);
  std::size_t total = 0, all = 0;
  for (const Body<D>& body : bodies) all += body.count();
  for (const Patch<D>& patch : grid.patches) {
    if (!patch.left_cell || scratch.changes_list_of(patch.body)) continue;
    const auto b = static_cast<std::size_t>(patch.body);
    scratch.first[b] = total;
    total += bodies[b].count();
  }
  constexpr std::size_t each = sizeof(*scratch.order) + sizeof(*scratch.cell);
  std::byte* const room = scratch.room(grid, each * total, each * std::min(2 * total, all));
  scratch.order = reinterpret_cast<std::uint32_t*>(room);
  scratch.cell = reinterpret_cast<std::uint8_t*>(scratch.order + total);
  return total > 0;
}

}  // namespace

template <int D>
bool mend_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies, Threads& threads,
                ListScratch<D>& scratch, Gone<D>& eroded_sums, Gone<D>& left_sums) {
  if (!find_lists(grid, bodies, scratch)) return false;
  scratch.notes.resize(grid.patches.size());
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    scratch.notes[p] =
        note_changes(grid, bodies[static_cast<std::size_t>(patch.body)], patch, scratch);
  });
  for (std::size_t p = 0; p < grid.patches.size(); ++p)
    bodies[static_cast<std::size_t>(grid.patches[p].body)].moved += scratch.notes[p].changes;
  const bool changed = hand_over_leavers(grid, bodies, threads, scratch);
  std::size_t first = 0, end = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b, first = end) {
    const int number = static_cast<int>(b);
    while (end < grid.patches.size() && grid.patches[end].body == number) ++end;
    if (scratch.changes_list_of(number) && bodies[b].at.recoverable >= 0)
      write_tail(std::span<const Patch<D>>(grid.patches.data() + first, end - first), bodies[b],
                 scratch.cell_of(number), scratch.order_of(number), eroded_sums, left_sums);
  }
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    Patch<D>& patch = grid.patches[p];
    if (scratch.changes_list_of(patch.body))
      write_list(bodies[static_cast<std::size_t>(patch.body)], patch, scratch.changes[p], scratch);
  });
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (scratch.changes_list_of(patch.body))
      std::copy_n(scratch.order_of(patch.body) + patch.begin, patch.count,
                  bodies[static_cast<std::size_t>(patch.body)].order.data() + patch.begin);
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::size_t gone = bodies[b].gone, rest = bodies[b].active();
    if (gone > 0 && scratch.changes_list_of(static_cast<int>(b)))
      std::copy_n(scratch.order_of(static_cast<int>(b)) + rest, gone,
                  bodies[b].order.data() + rest);
  }
  scratch.order = nullptr;
  scratch.cell = nullptr;
  grid.cut_blocks(threads);
  return changed;
}

template bool mend_lists<2>(TileGrid<2>&, std::vector<Body<2>>&, Threads&, ListScratch<2>&,
                            Gone<2>&, Gone<2>&);
template bool mend_lists<3>(TileGrid<3>&, std::vector<Body<3>>&, Threads&, ListScratch<3>&,
                            Gone<3>&, Gone<3>&);

}  // namespace mpm
