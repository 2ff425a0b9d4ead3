// Particles that have left their tiles: from which patch to which.
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "mpm/grid/connect.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/classify.hpp"
#include "mpm/particles/exchange_migrants.hpp"

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
  // A particle may go further than to the next tile in a step: there is no bound on speed (decision
  // 0002).
  if (!beside) return find_patch<D>(grid, patch.body, tile);
  return patch.neighbour[static_cast<std::size_t>(Tile<D>::neighbour(offset))];
}

template <int D>
void find_migrants(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                   const std::vector<ParticlePool<D>>& pools, Threads& threads,
                   ListScratch<D>& scratch) {
  // Each patch has counted its own; with the places known, all threads write without asking each
  // other (decision 0027), and the order is that of the patches.
  std::uint32_t count = 0;
  for (auto& note : scratch.notes) {
    note.first_migrant = count;
    count += note.migrants;
  }
  scratch.migrants.resize(count);
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    if (scratch.notes[p].migrants == 0) return;
    const Patch<D>& patch = grid.patches[p];
    const auto m = pool_number(bodies, patch.body);
    const std::uint8_t* mark = scratch.marks + scratch.notes[p].first_mark;
    Migrant<D>* to = &scratch.migrants[scratch.notes[p].first_migrant];
    for (const std::uint32_t row : pools[m].rows(patch)) {
      if (*mark++ != CellMark::outside) continue;
      const auto [tile, cell] = grid.tile_and_cell(listed_place(pools[m], row));
      *to++ = {patch.body, tile, patch_beside<D>(grid, patch, tile), row,
               static_cast<std::uint8_t>(cell)};
    }
  });
}

/// Put new patches, sorted, among the others.
template <int D>
void merge(std::vector<Patch<D>>& patches, const std::vector<Body<D>>& bodies,
           const std::vector<std::pair<int, Index<D>>>& added) {
  // From the end, in place: nothing is written over that has not been moved yet.
  std::size_t from = patches.size(), to = from + added.size(), next = added.size();
  patches.resize(to);
  while (next > 0) {
    const auto& [body, tile] = added[next - 1];
    if (from > 0 && patch_less<D>(body, tile, patches[from - 1].body, patches[from - 1].tile)) {
      patches[--to] = patches[--from];
    } else {
      Patch<D>& patch = patches[--to] = {};
      patch.body = body;
      patch.keeps = bodies[static_cast<std::size_t>(body)].keeps_nodes();
      patch.tile = tile;
      --next;
    }
  }
}

/// Add patches for tiles that a body enters, and drop the empty ones; true if the set of patches
/// has changed.
template <int D>
bool add_patches(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, ListScratch<D>& scratch) {
  auto& patches = grid.patches;
  auto& entered = scratch.entered;
  auto& number = scratch.number;
  number.resize(patches.size());
  const auto no_patch = [](const Migrant<D>& l) { return l.patch < 0; };
  // The usual step: nothing is added, and empty patches may stay a while.
  if (std::none_of(scratch.migrants.begin(), scratch.migrants.end(), no_patch)) {
    std::iota(number.begin(), number.end(), 0);
    return false;
  }
  const auto is_empty = [](const Patch<D>& patch) { return patch.count == 0 && !patch.foreign; };
  // Empty patches are dropped only here, where numbers change anyway: contact and neighbours go by
  // the numbers of patches, and a particle that comes back into a tile finds its patch again.
  for (std::size_t p = 0; p < patches.size(); ++p) number[p] = is_empty(patches[p]) ? -1 : 0;
  entered.clear();
  for (Migrant<D>& l : scratch.migrants) {
    // It goes to a patch that is about to be dropped, which is then made anew for it.
    if (l.patch >= 0 && number[static_cast<std::size_t>(l.patch)] < 0) l.patch = -1;
    if (l.patch < 0) entered.emplace_back(l.body, l.tile);
  }
  std::sort(entered.begin(), entered.end(), [](const auto& x, const auto& y) {
    return patch_less<D>(x.first, x.second, y.first, y.second);
  });
  entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
  std::erase_if(patches, is_empty);
  merge<D>(patches, bodies, entered);
  // The others have kept their order, and the new ones are still empty.
  std::size_t next = 0;
  for (std::int32_t& n : number) {
    if (n < 0) continue;
    while (is_empty(patches[next])) ++next;
    n = static_cast<std::int32_t>(next++);
  }
  return true;
}

/// How many particles each patch keeps and gets, and which ones.
template <int D>
void find_changes(const TileGrid<D>& grid, ListScratch<D>& scratch) {
  auto& changes = scratch.changes;
  changes.assign(grid.patches.size(), {});
  for (std::size_t p = 0; p < scratch.notes.size(); ++p) {
    if (scratch.number[p] < 0) continue;
    auto& change = changes[static_cast<std::size_t>(scratch.number[p])];
    const auto& note = scratch.notes[p];
    change.first_mark = note.first_mark;
    change.kept = note.kept;
    change.removed = note.removed;
    change.begin = note.begin;
    change.room = note.room;
    change.body = note.body;
    change.rewritten = note.left_cell;
  }
  for (Migrant<D>& m : scratch.migrants) {
    m.patch = m.patch < 0 ? find_patch<D>(grid, m.body, m.tile)
                          : scratch.number[static_cast<std::size_t>(m.patch)];
    auto& change = changes[static_cast<std::size_t>(m.patch)];
    ++change.arrivals_end;  // so far their number
    change.body = m.body;
    change.rewritten = true;
  }
  std::uint32_t arrival = 0;
  for (auto& c : changes) {
    const std::uint32_t count = std::exchange(c.arrivals_end, arrival);  // the end moves on below
    c.first_arrival = arrival;
    arrival += count;
  }
  scratch.arrivals.resize(arrival);
  // The second half of a counting sort. Nobody needs a patch's arrivals in order: its list is by
  // cell and number (decision 0033).
  for (const Migrant<D>& m : scratch.migrants)
    scratch.arrivals[changes[static_cast<std::size_t>(m.patch)].arrivals_end++] = {m.row, m.cell};
}

/// Where the lists of the patches go: those that outgrow their ranges get others behind all, and if
/// there is no room the lists of the pool are laid out anew.
template <int D>
void find_ranges(const std::vector<Body<D>>& bodies, std::vector<ParticlePool<D>>& pools,
                 ListScratch<D>& scratch) {
  using Change = typename ListScratch<D>::Change;
  const auto give = [&](Change& change) {
    std::size_t& used = pools[pool_number(bodies, change.body)].used;
    change.begin = static_cast<std::uint32_t>(used);
    change.room = room_for(change.count());
    used += change.room;
  };
  // In the order of the patches, by one thread: ranges depend on the case alone.
  for (Change& change : scratch.changes)
    if (change.count() > change.room) give(change);
  bool any = false;
  scratch.full.assign(pools.size(), false);
  for (std::size_t m = 0; m < pools.size(); ++m) {
    if (pools[m].used <= pools[m].order.size()) continue;
    any = true;
    scratch.full[m] = true;
    // All of its patches get new ranges from the front; what outgrown ranges have left behind is
    // free again.
    pools[m].used = 0;
  }
  if (!any) return;
  for (Change& change : scratch.changes)
    if (scratch.full[pool_number(bodies, change.body)]) {
      change.rewritten = true;
      give(change);
    }
  for (std::size_t m = 0; m < pools.size(); ++m)
    if (scratch.full[m])
      pools[m].order.resize(
          std::max(pools[m].order.size(), pools[m].used + spare_room(pools[m].used)));
}

}  // namespace

template <int D>
bool migrate_particles(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, Threads& threads,
                       ListScratch<D>& scratch) {
  find_migrants(grid, bodies, pools, threads, scratch);
  if (!grid.partition.alone()) exchange_migrants(grid, bodies, pools, scratch);
  const bool changed = add_patches(grid, bodies, scratch);
  find_changes(grid, scratch);
  find_ranges(bodies, pools, scratch);
  return changed;
}

template bool migrate_particles<2>(TileGrid<2>&, const std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, Threads&, ListScratch<2>&);
template bool migrate_particles<3>(TileGrid<3>&, const std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, Threads&, ListScratch<3>&);

}  // namespace mpm
