#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>

#include "mpm/particles/classify.hpp"
#include "mpm/particles/lists.hpp"

namespace mpm {
namespace {

/// The patch of the same body in a tile, mostly one beside its own; -1 if there is none.
template <int D>
std::int32_t patch_beside(const TileGrid<D>& grid, const Patch<D>& patch, const Index<D>& tile) {
  Index<D> offset;
  bool beside = !grid.bonded;  // there neighbours are those of all bodies
  for (std::size_t a = 0; a < D; ++a) {
    offset[a] = tile[a] - patch.tile[a];
    beside = beside && std::abs(offset[a]) <= 1;
  }
  if (!beside) return grid.find(patch.body, tile);
  return patch.neighbour[static_cast<std::size_t>(Tile<D>::neighbour(offset))];
}

template <int D>
void find_leavers(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  ListScratch<D>& scratch) {
  auto& leavers = scratch.leavers;
  leavers.clear();
  for (const Patch<D>& patch : grid.patches) {
    if (!patch.left_cell) continue;
    const Body<D>& body = bodies[static_cast<std::size_t>(patch.body)];
    const std::uint8_t* cells = scratch.cell_of(patch.body);
    for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k) {
      if (cells[k] != CellMark::outside) continue;
      Vec<double, D> x;
      for (int a = 0; a < D; ++a) x[a] = body.x(a)[body.order[k]];
      const Index<D> cell = grid.cell_of(x), tile = grid.tile_of(cell);
      const Index<D> first = grid.first_cell(tile);
      Index<D> local;
      for (int a = 0; a < D; ++a) local[a] = cell[a] - first[a];
      leavers.push_back({patch.body, tile, patch_beside<D>(grid, patch, tile), body.order[k],
                         static_cast<std::uint8_t>(Tile<D>::cell(local))});
    }
  }
  // Patches are in the order of their bodies and tiles.
  std::sort(leavers.begin(), leavers.end(), [](const Leaver<D>& x, const Leaver<D>& y) {
    if (x.patch >= 0 && y.patch >= 0) return x.patch != y.patch ? x.patch < y.patch : x.row < y.row;
    if (x.body != y.body || x.tile != y.tile) return patch_less<D>(x.body, x.tile, y.body, y.tile);
    return x.row < y.row;
  });
}

/// Add patches for tiles that a body enters, and drop the empty ones; true if the set of patches
/// has changed.
template <int D>
bool merge_new_patches(TileGrid<D>& grid, ListScratch<D>& scratch) {
  const auto no_patch = [](const Leaver<D>& l) { return l.patch < 0; };
  if (std::none_of(scratch.leavers.begin(), scratch.leavers.end(), no_patch)) return false;
  auto &patches = grid.patches, &added = scratch.added;
  for (Leaver<D>& l : scratch.leavers)
    if (!no_patch(l) && patches[static_cast<std::size_t>(l.patch)].count == 0) l.patch = -1;
  std::erase_if(patches, [](const Patch<D>& patch) { return patch.count == 0; });
  added.clear();
  for (const Leaver<D>& l : scratch.leavers) {
    if (!added.empty() && added.back().body == l.body && added.back().tile == l.tile) continue;
    if (!no_patch(l)) continue;
    Patch<D>& patch = added.emplace_back();
    patch.body = l.body;
    patch.tile = l.tile;
  }
  std::size_t from = patches.size(), to = from + added.size(), next = added.size();
  patches.resize(to);
  while (next > 0) {
    const Patch<D>& last = added[next - 1];
    if (from > 0 &&
        patch_less<D>(last.body, last.tile, patches[from - 1].body, patches[from - 1].tile))
      patches[--to] = patches[--from];
    else
      patches[--to] = added[--next];
  }
  grid.connect();
  return true;
}

/// Write a patch's new list: the particles it keeps and those that come, by cell, then by row.
template <int D>
void write_list(const Body<D>& body, Patch<D>& patch, const typename ListScratch<D>::Change& change,
                ListScratch<D>& scratch) {
  std::uint32_t* to = scratch.order_of(patch.body) + change.begin;
  std::uint8_t* cell = scratch.cell_of(patch.body);
  if (!patch.left_cell && change.arrival_count == 0) {
    std::memcpy(to, body.order.data() + patch.begin, patch.count * sizeof(std::uint32_t));
    patch.begin = change.begin;
    return;
  }
  if (!patch.left_cell)
    patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
      std::memset(cell + begin, c, end - begin);
    });
  const Leaver<D>* arrival = scratch.leavers.data() + change.arrival_begin;
  constexpr int cells = Tile<D>::cell_count;
  std::array<std::uint32_t, cells + 1> begin{};
  for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
    if (cell[k] < CellMark::left) ++begin[cell[k] + std::size_t{1}];
  for (std::uint32_t k = 0; k < change.arrival_count; ++k)
    ++begin[arrival[k].cell + std::size_t{1}];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  auto next = begin;
  auto put = [&](std::uint8_t c, std::uint32_t row) {
    std::uint32_t at = next[c]++;
    for (; at > begin[c] && to[at - 1] > row; --at) to[at] = to[at - 1];
    to[at] = row;
  };
  for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
    if (cell[k] < CellMark::left) put(cell[k], body.order[k]);
  for (std::uint32_t k = 0; k < change.arrival_count; ++k) put(arrival[k].cell, arrival[k].row);

  patch.begin = change.begin;
  patch.count = change.kept + change.arrival_count;
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
bool find_changes(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, ListScratch<D>& scratch) {
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

/// How many particles each patch keeps and gets, and where its list begins.
template <int D>
void count_changes(const std::vector<Patch<D>>& patches, ListScratch<D>& scratch) {
  auto& changes = scratch.changes;
  changes.assign(patches.size(), {});
  std::uint32_t arrival = 0, begin = 0;
  const auto total = static_cast<std::uint32_t>(scratch.leavers.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Patch<D>& patch = patches[p];
    if (p == 0 || patches[p - 1].body != patch.body) begin = 0;
    auto& c = changes[p];
    c.kept = patch.count;
    if (patch.left_cell) {
      const std::uint8_t* cell = scratch.cell_of(patch.body);
      for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
        c.kept -= cell[k] >= CellMark::left;
    }
    c.arrival_begin = arrival;
    while (arrival < total && scratch.leavers[arrival].body == patch.body &&
           scratch.leavers[arrival].tile == patch.tile)
      ++arrival;
    c.arrival_count = arrival - c.arrival_begin;
    c.begin = begin;
    begin += c.kept + c.arrival_count;
  }
}

}  // namespace

template <int D>
bool mend_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies, Threads& threads,
                ListScratch<D>& scratch, Gone<D>& eroded_sums, Gone<D>& left_sums) {
  if (!find_changes(grid, bodies, scratch)) return false;
  scratch.moved.assign(grid.patches.size(), 0);
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (!patch.left_cell) return;
    const Body<D>& body = bodies[static_cast<std::size_t>(patch.body)];
    std::uint8_t* const cells = scratch.cell_of(patch.body);
    scratch.moved[p] = note_cells(grid, body, patch, cells) + note_gone(grid, body, patch, cells);
  });
  for (std::size_t p = 0; p < grid.patches.size(); ++p)
    bodies[static_cast<std::size_t>(grid.patches[p].body)].moved += scratch.moved[p];
  find_leavers(grid, bodies, scratch);
  const bool changed = merge_new_patches(grid, scratch);
  count_changes(grid.patches, scratch);
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
