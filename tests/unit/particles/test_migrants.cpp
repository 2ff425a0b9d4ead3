// Particles that leave their tiles: each arrives once, at the patch of its body in the tile in
// which it is, in its cell; patches are there for all that are needed, in order; and their lists
// have room.
#include <algorithm>
#include <set>

#include "check.hpp"
#include "mpm/particles/classify.hpp"
#include "particles/scattered.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

template <int D>
using Place = std::pair<int, Index<D>>;  // body and tile

/// What the caller of migrate_particles notes of the patches.
template <int D>
std::vector<std::uint8_t> note(Scattered<D>& world) {
  const auto& patches = world.grid.patches;
  std::vector<std::uint8_t> marks;
  auto& notes = world.scratch.notes;
  notes.assign(patches.size(), {});
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Patch<D>& patch = patches[p];
    notes[p].body = patch.body;
    notes[p].begin = patch.begin;
    notes[p].room = patch.room;
    notes[p].kept = patch.count;
    notes[p].left_cell = patch.left_cell;
    if (!patch.left_cell) continue;
    notes[p].first_mark = marks.size();
    marks.resize(marks.size() + patch.count);
    std::uint8_t* const own = marks.data() + notes[p].first_mark;
    note_cells(world.grid, world.pool_of(patch), patch, own);
    notes[p].migrants =
        static_cast<std::uint32_t>(std::count(own, own + patch.count, CellMark::outside));
    notes[p].kept -= notes[p].migrants;
  }
  return marks;
}

/// Who should come where: row and cell; and the patches that there should be.
template <int D>
struct Expected {
  std::map<Place<D>, std::set<std::pair<std::uint32_t, int>>> arrivals;
  std::map<Place<D>, std::uint32_t> kept;
  std::set<Place<D>> places;
  bool changed = false;

  explicit Expected(Scattered<D>& world) {
    std::set<Place<D>> all, filled;
    for (const Patch<D>& patch : world.grid.patches) {
      all.insert({patch.body, patch.tile});
      if (patch.count > 0) filled.insert({patch.body, patch.tile});
      for (const std::uint32_t row : world.pool_of(patch).rows(patch)) {
        const Index<D> cell = world.grid.cell_of(world.pool_of(patch).position_of(row));
        Patch<D> to;
        to.body = patch.body;
        to.tile = world.grid.tile_of(cell);
        if (to.tile == patch.tile)
          ++kept[{patch.body, patch.tile}];
        else
          arrivals[{to.body, to.tile}].insert({row, world.mark_of(to, row)});
      }
    }
    for (const auto& [place, who] : arrivals) changed = changed || !all.contains(place);
    // Only where patches come, those go that have been empty.
    places = changed ? filled : all;
    for (const auto& [place, who] : arrivals) places.insert(place);
  }
};

template <int D>
void check_patches(Report& report, const Scattered<D>& world, const Expected<D>& expected) {
  const auto& patches = world.grid.patches;
  CHECK_EQUAL(patches.size(), expected.places.size());
  CHECK_EQUAL(world.scratch.changes.size(), patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Place<D> place{patches[p].body, patches[p].tile};
    CHECK(expected.places.contains(place), p);
    CHECK(p == 0 || patch_less<D>(patches[p - 1].body, patches[p - 1].tile, patches[p].body,
                                  patches[p].tile),
          p);
    const auto& change = world.scratch.changes[p];
    const auto kept = expected.kept.find(place);
    CHECK_EQUAL(change.kept, kept == expected.kept.end() ? 0u : kept->second);
    std::set<std::pair<std::uint32_t, int>> arrived;
    for (std::uint32_t k = change.first_arrival; k < change.arrivals_end; ++k)
      arrived.insert({world.scratch.arrivals[k].row, world.scratch.arrivals[k].cell});
    CHECK_EQUAL(arrived.size(), std::size_t{change.arrivals_end - change.first_arrival});
    const auto who = expected.arrivals.find(place);
    CHECK(arrived == (who == expected.arrivals.end() ? decltype(arrived){} : who->second), p);
    CHECK(change.rewritten || (!patches[p].left_cell && arrived.empty()), p);
  }
}

/// The ranges of a pool's lists hold the particles that they get, within the pool, and none meets
/// another.
template <int D>
void check_ranges(Report& report, const Scattered<D>& world) {
  std::vector<std::map<std::uint32_t, std::uint32_t>> ranges(world.pools.size());
  for (std::size_t p = 0; p < world.grid.patches.size(); ++p) {
    const auto& change = world.scratch.changes[p];
    CHECK(change.count() <= change.room, p, change.count(), change.room);
    if (change.room == 0) continue;
    const std::size_t m = pool_number(world.bodies, world.grid.patches[p].body);
    CHECK(ranges[m].try_emplace(change.begin, change.begin + change.room).second, p);
  }
  for (std::size_t m = 0; m < ranges.size(); ++m) {
    std::uint32_t end = 0;
    for (const auto& [begin, its_end] : ranges[m]) {
      CHECK(begin >= end, begin, end);
      end = its_end;
    }
    CHECK(end <= world.pools[m].used && world.pools[m].used <= world.pools[m].order.size(), end);
  }
}

/// How often that came about.
struct Counts {
  int changed = 0, same = 0;  // the set of patches
  int full = 0;               // no room behind the lists of a pool
};

/// Once all have moved and some patches are empty, they move again.
template <int D>
void check_moves(Report& report, unsigned seed, bool bonded, double way, Counts& counts) {
  Scattered<D> world(seed, basis_id<Linear>, bonded, 20 * seed);
  world.move(1.0);
  world.update();
  world.move(way);
  const Expected<D> expected(world);
  std::vector<std::uint8_t> marks = note(world);
  world.scratch.marks = marks.data();
  const bool changed =
      migrate_particles(world.grid, world.bodies, world.pools, world.threads, world.scratch);
  CHECK_EQUAL(changed, expected.changed);
  check_patches(report, world, expected);
  check_ranges(report, world);
  ++(changed ? counts.changed : counts.same);
  counts.full += std::ranges::count(world.scratch.full, 1) > 0;
}

template <int D>
void check_migrants(Report& report) {
  Counts counts;
  for (const bool bonded : {false, true})
    for (unsigned seed = 1; seed <= 20; ++seed)
      for (const double way : {0.002, 0.5, 4.0}) check_moves<D>(report, seed, bonded, way, counts);
  CHECK(counts.changed > 5 && counts.same > 5, counts.changed, counts.same);
  CHECK(counts.full > 5, counts.full);
}

}  // namespace

void test_migrants(Report& report) {
  check_migrants<2>(report);
  check_migrants<3>(report);
}
