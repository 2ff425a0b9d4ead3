// Particles that have left their tiles: from which patch to which.
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

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
void find_leavers(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies, Threads& threads,
                  ListScratch<D>& scratch) {
  std::uint32_t count = 0;
  for (auto& note : scratch.notes) {
    note.first_leaver = count;
    count += note.leavers;
  }
  scratch.leavers.resize(count);
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    if (scratch.notes[p].leavers == 0) return;
    const Patch<D>& patch = grid.patches[p];
    const Body<D>& body = bodies[static_cast<std::size_t>(patch.body)];
    const std::uint8_t* cells = scratch.cell_of(patch.body);
    Leaver<D>* to = &scratch.leavers[scratch.notes[p].first_leaver];
    for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k) {
      if (cells[k] != CellMark::outside) continue;
      Vec<double, D> x;
      for (int a = 0; a < D; ++a) x[a] = body.x(a)[body.order[k]];
      const Index<D> cell = grid.cell_of(x), tile = grid.tile_of(cell);
      const Index<D> first = grid.first_cell(tile);
      Index<D> local;
      for (int a = 0; a < D; ++a) local[a] = cell[a] - first[a];
      *to++ = {patch.body, tile, patch_beside<D>(grid, patch, tile), body.order[k],
               static_cast<std::uint8_t>(Tile<D>::cell(local))};
    }
  });
}

/// Put new patches, sorted, among the others.
template <int D>
void merge(std::vector<Patch<D>>& patches, const std::vector<std::pair<int, Index<D>>>& added) {
  std::size_t from = patches.size(), to = from + added.size(), next = added.size();
  patches.resize(to);
  while (next > 0) {
    const auto& [body, tile] = added[next - 1];
    if (from > 0 && patch_less<D>(body, tile, patches[from - 1].body, patches[from - 1].tile)) {
      patches[--to] = patches[--from];
    } else {
      Patch<D>& patch = patches[--to] = {};
      patch.body = body;
      patch.tile = tile;
      --next;
    }
  }
}

/// Add patches for tiles that a body enters, and drop the empty ones; true if the set of patches
/// has changed.
template <int D>
bool add_patches(TileGrid<D>& grid, ListScratch<D>& scratch) {
  auto& patches = grid.patches;
  auto& entered = scratch.entered;
  auto& number = scratch.number;
  number.resize(patches.size());
  const auto no_patch = [](const Leaver<D>& l) { return l.patch < 0; };
  if (std::none_of(scratch.leavers.begin(), scratch.leavers.end(), no_patch)) {
    std::iota(number.begin(), number.end(), 0);
    return false;
  }
  for (std::size_t p = 0; p < patches.size(); ++p) number[p] = patches[p].count == 0 ? -1 : 0;
  entered.clear();
  for (Leaver<D>& l : scratch.leavers) {
    if (l.patch >= 0 && number[static_cast<std::size_t>(l.patch)] < 0) l.patch = -1;
    if (l.patch < 0) entered.emplace_back(l.body, l.tile);
  }
  std::sort(entered.begin(), entered.end(), [](const auto& x, const auto& y) {
    return patch_less<D>(x.first, x.second, y.first, y.second);
  });
  entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
  std::erase_if(patches, [](const Patch<D>& patch) { return patch.count == 0; });
  merge<D>(patches, entered);
  // The others have kept their order, and the new ones are still empty.
  std::size_t next = 0;
  for (std::int32_t& n : number) {
    if (n < 0) continue;
    while (patches[next].count == 0) ++next;
    n = static_cast<std::int32_t>(next++);
  }
  grid.connect();
  return true;
}

/// How many particles each patch keeps and gets, which ones, and where its list begins.
template <int D>
void find_changes(const TileGrid<D>& grid, ListScratch<D>& scratch) {
  auto& changes = scratch.changes;
  changes.assign(grid.patches.size(), {});
  for (std::size_t p = 0; p < scratch.notes.size(); ++p)
    if (scratch.number[p] >= 0)
      changes[static_cast<std::size_t>(scratch.number[p])].kept = scratch.notes[p].kept;
  for (Leaver<D>& l : scratch.leavers) {
    l.patch =
        l.patch < 0 ? grid.find(l.body, l.tile) : scratch.number[static_cast<std::size_t>(l.patch)];
    ++changes[static_cast<std::size_t>(l.patch)].arrivals_end;  // so far their number
  }
  std::uint32_t arrival = 0, begin = 0;
  for (std::size_t p = 0; p < changes.size(); ++p) {
    if (p == 0 || grid.patches[p - 1].body != grid.patches[p].body) begin = 0;
    auto& c = changes[p];
    const std::uint32_t count = std::exchange(c.arrivals_end, arrival);  // the end moves on below
    c.first_arrival = arrival;
    c.begin = begin;
    arrival += count;
    begin += c.kept + count;
  }
  scratch.arrivals.resize(arrival);
  for (const Leaver<D>& l : scratch.leavers)
    scratch.arrivals[changes[static_cast<std::size_t>(l.patch)].arrivals_end++] = {l.row, l.cell};
}

}  // namespace

template <int D>
bool hand_over_leavers(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, Threads& threads,
                       ListScratch<D>& scratch) {
  find_leavers(grid, bodies, threads, scratch);
  const bool changed = add_patches(grid, scratch);
  find_changes(grid, scratch);
  return changed;
}

template bool hand_over_leavers<2>(TileGrid<2>&, const std::vector<Body<2>>&, Threads&,
                                   ListScratch<2>&);
template bool hand_over_leavers<3>(TileGrid<3>&, const std::vector<Body<3>>&, Threads&,
                                   ListScratch<3>&);

}  // namespace mpm
