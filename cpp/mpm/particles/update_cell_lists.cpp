#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/grid/foreign_patches.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/classify.hpp"

namespace mpm {
namespace {

/// Room for the marks of patches that particles have left, and for all lists of their pools; false
/// if there are none.
template <int D>
bool make_scratch(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools, ListScratch<D>& scratch) {
  auto& touched = scratch.touched;
  touched.assign(pools.size(), false);
  scratch.notes.resize(grid.patches.size());
  std::size_t marks = 0, entries = 0, all = 0;
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const Patch<D>& patch = grid.patches[p];
    auto& note = scratch.notes[p] = {};
    note.body = patch.body;
    note.begin = patch.begin;
    note.room = patch.room;
    note.kept = patch.count;
    note.left_cell = patch.left_cell;
    if (!patch.left_cell) continue;
    note.first_mark = marks;
    marks += patch.count;
    touched[pool_number(bodies, patch.body)] = true;
  }
  for (std::size_t m = 0; m < pools.size(); ++m) {
    all += pools[m].count();
    // An upper bound: who arrives somewhere has left a patch of the same pool. From other ranks
    // come who knows how many.
    if (touched[m] && grid.partition.alone()) entries += pools[m].count();
  }
  // Entries before marks: those of four bytes need the alignment that the memory begins with.
  constexpr std::size_t entry = sizeof(*scratch.lists), mark = sizeof(*scratch.marks);
  std::byte* const room = scratch.room(grid, entry * entries + mark * marks, (entry + mark) * all);
  scratch.lists = reinterpret_cast<std::uint32_t*>(room);
  scratch.marks = reinterpret_cast<std::uint8_t*>(scratch.lists + entries);
  return marks > 0;
}

/// Note the cells of a patch's particles, and how many go where.
template <int D>
void note_changes(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
                  const Patch<D>& patch, bool removes, ListScratch<D>& scratch,
                  typename ListScratch<D>::Note& note) {
  std::uint8_t* const marks = scratch.marks + note.first_mark;
  std::size_t changes = note_cells(grid, pool, patch, marks);
  if (removes) changes += note_removed(grid, body, pool, patch, marks);
  note.changes = static_cast<std::uint32_t>(changes);
  const std::span<std::uint8_t> now(marks, patch.count);
  if (grid.partition.leaves(patch))
    for (std::uint8_t& mark : now) mark = mark < CellMark::left ? CellMark::outside : mark;
  note.migrants = static_cast<std::uint32_t>(std::ranges::count(now, CellMark::outside));
  const auto others = static_cast<std::uint32_t>(
      std::ranges::count_if(now, [](std::uint8_t c) { return c >= CellMark::left; }));
  note.removed = others - note.migrants;
  // The marks are ordered by CellMark: cells, then those removed, then those outside.
  note.kept = patch.count - others;
}

/// Count the changes of each body, and list the bodies that have any.
template <int D>
void count_changes(std::vector<Body<D>>& bodies, ListScratch<D>& scratch) {
  for (const auto& note : scratch.notes) {
    if (note.changes == 0) continue;
    bodies[static_cast<std::size_t>(note.body)].moved += note.changes;
    // Notes are in the order of the patches, bodies one after another, so that the last is enough.
    if (scratch.moved.empty() || scratch.moved.back() != note.body)
      scratch.moved.push_back(note.body);
  }
}

/// Take what a particle has out of the sums of those that take part.
template <int D>
void take_out(const Body<D>& body, const ParticlePool<D>& pool, std::uint32_t row,
              double affine_moment, Removed& sums) {
  const Vector3 turning = angular_momentum(pool, row, affine_moment, Vector3::zero());
  sums.add({pool.mass()[row], kinetic_energy(pool, row, affine_moment),
            recoverable_energy(body, pool, row), turning[0], turning[1], turning[2]});
}

/// Those of a patch's particles that take no part any more.
template <int D>
void remove_particles(Body<D>& body, ParticlePool<D>& pool, const Patch<D>& patch,
                      const std::uint8_t* mark, double affine_moment, Removed& eroded,
                      Removed& outflow) {
  // By one thread, in the order of the lists, for rows are pushed back.
  for (const std::uint32_t row : pool.rows(patch)) {
    const std::uint8_t now = *mark++;
    if (now != CellMark::eroded && now != CellMark::left) continue;
    take_out(body, pool, row, affine_moment, now == CellMark::left ? outflow : eroded);
    if (now == CellMark::left) pool.columns.component(pool.at.failed)[row] = left_region;
    pool.removed.push_back({row, patch.body});
    ++body.removed_here;
  }
}

/// How many of each body's particles take no part any more, of all ranks.
template <int D>
void count_removed(std::vector<Body<D>>& bodies, Comm& comm) {
  if (comm.alone()) {
    for (Body<D>& body : bodies) body.removed = body.removed_here;
    return;
  }
  std::int64_t here = 0, before = 0;
  for (const Body<D>& body : bodies) {
    here += static_cast<std::int64_t>(body.removed_here);
    before += static_cast<std::int64_t>(body.removed);
  }
  if (all_sum(comm, here) == before) return;
  std::vector<std::int64_t> counts;
  counts.reserve(bodies.size());
  for (const Body<D>& body : bodies) counts.push_back(static_cast<std::int64_t>(body.removed_here));
  comm.all_sum(counts);
  for (std::size_t b = 0; b < counts.size(); ++b)
    bodies[b].removed = static_cast<std::size_t>(counts[b]);
}

/// Write a patch's new list to scratch: the particles it keeps and those that come, by cell, then
/// by id: sums over the particles of a cell must not depend on where their rows are.
template <int D>
void write_list(const ParticlePool<D>& pool, Patch<D>& patch,
                const typename ListScratch<D>::Change& change, const ListScratch<D>& scratch) {
  std::uint32_t* const to = scratch.lists + change.first_entry;
  const std::span<const Arrival> arrivals(scratch.arrivals.data() + change.first_arrival,
                                          scratch.arrivals.data() + change.arrivals_end);
  // Only moved, for all lists of its pool are laid out anew.
  if (!patch.left_cell && arrivals.empty()) {
    std::ranges::copy(pool.rows(patch), to);
    return;
  }
  // Where nobody has left its cell there are no marks, and the cells are those of the old list.
  const auto for_each_kept = [&](auto&& f) {
    if (patch.left_cell) {
      const std::uint8_t* mark = scratch.marks + change.first_mark;
      for (const std::uint32_t row : pool.rows(patch))
        if (const std::uint8_t cell = *mark++; cell < CellMark::left) f(std::size_t{cell}, row);
    } else {
      patch.for_each_cell([&](int cell, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k)
          f(static_cast<std::size_t>(cell), pool.order[k]);
      });
    }
  };
  constexpr int cells = Tile<D>::cell_count;
  std::array<std::uint32_t, cells + 1> begin{};
  // Counting sort by cell; within a cell by insertion, which costs next to nothing, as those that
  // stay come in their order already.
  for_each_kept([&](std::size_t cell, std::uint32_t) { ++begin[cell + 1]; });
  for (const Arrival& arrival : arrivals) ++begin[arrival.cell + std::size_t{1}];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  auto next = begin;
  const auto put = [&](std::size_t c, std::uint32_t row) {
    std::uint32_t at = next[c]++;
    for (; at > begin[c] && pool.id[to[at - 1]] > pool.id[row]; --at) to[at] = to[at - 1];
    to[at] = row;
  };
  for_each_kept(put);
  for (const Arrival& arrival : arrivals) put(arrival.cell, arrival.row);

  patch.count = begin[cells];
  patch.cell_begin = begin;
  patch.occupied = 0;
  for (int c = 0; c < cells; ++c)
    if (begin[static_cast<std::size_t>(c) + 1] > begin[static_cast<std::size_t>(c)])
      patch.occupied |= std::uint64_t{1} << c;
  // Until the stage that moves particles sees one leave its cell again.
  patch.left_cell = false;
}

/// The new lists of all patches that are rewritten, each in its range.
template <int D>
void write_lists(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                 std::vector<ParticlePool<D>>& pools, Threads& threads, ListScratch<D>& scratch) {
  std::size_t entries = 0;
  for (auto& change : scratch.changes) {
    if (!change.rewritten) continue;
    change.first_entry = entries;
    entries += change.count();
  }
  if (!grid.partition.alone()) {
    make_room(scratch.own_lists, entries, entries + entries / 16);
    scratch.lists = scratch.own_lists.data();
  }
  const auto place = [&](std::size_t p) {
    const auto& change = scratch.changes[p];
    Patch<D>& patch = grid.patches[p];
    patch.begin = change.begin;
    patch.room = change.room;
    std::copy_n(scratch.lists + change.first_entry, patch.count,
                pools[pool_number(bodies, change.body)].order.data() + patch.begin);
  };
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const auto& change = scratch.changes[p];
    if (!change.rewritten) return;
    const std::size_t m = pool_number(bodies, change.body);
    write_list(pools[m], grid.patches[p], change, scratch);
    // A range of its own, old or new, that no other patch reads.
    if (!scratch.full[m]) place(p);
  });
  // Where all lists are laid out anew, one goes where others were.
  if (std::ranges::none_of(scratch.full, std::identity())) return;
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    if (scratch.full[pool_number(bodies, scratch.changes[p].body)]) place(p);
  });
}

}  // namespace

template <int D>
bool update_cell_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, Threads& threads,
                       ListScratch<D>& scratch, Removed* eroded, Removed* outflow) {
  scratch.moved.clear();
  // Others may have what comes here, though nothing has moved.
  const bool alone = grid.partition.alone();
  if (!make_scratch(grid, bodies, pools, scratch) && alone) return false;
  const auto body_of = [&](const Patch<D>& patch) -> Body<D>& {
    return bodies[static_cast<std::size_t>(patch.body)];
  };
  const auto pool_of = [&](const Patch<D>& patch) -> ParticlePool<D>& {
    return pools[pool_number(bodies, patch.body)];
  };
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (patch.left_cell)
      note_changes(grid, body_of(patch), pool_of(patch), patch, eroded != nullptr, scratch,
                   scratch.notes[p]);
  });
  count_changes(bodies, scratch);
  // Numbers of patches mean something else from here on: `notes` has the old ones, `changes` the
  // new.
  bool changed = migrate_particles(grid, bodies, pools, threads, scratch);
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const auto& change = scratch.changes[p];
    if (change.removed == 0) continue;
    const Patch<D>& patch = grid.patches[p];
    remove_particles(body_of(patch), pool_of(patch), patch, scratch.marks + change.first_mark,
                     grid.affine_moment(), *eroded, *outflow);
  }
  if (eroded != nullptr && may_remove(grid, pools)) count_removed(bodies, *grid.partition.comm);
  write_lists(grid, bodies, pools, threads, scratch);
  // They lie in the memory of the nodes, which gets its blocks now.
  scratch.lists = nullptr;
  scratch.marks = nullptr;
  if (!alone && exchange_patches(grid)) changed = true;
  // Numbers have changed, and with them everyone's neighbours; or a body has left a tile.
  if (changed || !leaders_are_known(grid)) connect(grid);
  cut_blocks(grid, threads);
  return changed;
}

template bool update_cell_lists<2>(TileGrid<2>&, std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, Threads&, ListScratch<2>&,
                                   Removed*, Removed*);
template bool update_cell_lists<3>(TileGrid<3>&, std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, Threads&, ListScratch<3>&,
                                   Removed*, Removed*);

}  // namespace mpm
