// Who of a pool is whose: patches and rows of a body, those that take part and those that do not;
// and room that is lent.
#include <algorithm>
#include <set>

#include "check.hpp"
#include "particles/scattered.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Every row of every pool is once among those of some body, and says who it is.
template <int D>
void check_pool(Report& report) {
  Scattered<D> world(5, basis_id<Linear>, false, 50);
  for (int round = 0; round < 3; ++round) {
    world.move(2.0);
    world.fail_some();
    world.update();
  }
  CHECK(world.eroded.count > 5, world.eroded.count);
  std::vector<std::set<std::uint32_t>> seen(world.pools.size());
  for (int b = 0; b < 3; ++b) {
    const Body<D>& body = world.bodies[static_cast<std::size_t>(b)];
    const std::size_t m = pool_number(world.bodies, b);
    const ParticlePool<D>& pool = world.pools[m];
    for (const Patch<D>& patch : patches_of<D>(world.grid.patches, b)) CHECK_EQUAL(patch.body, b);
    std::size_t active = 0, all = 0;
    std::set<std::uint32_t> ids;
    for_each_active_row(world.grid.patches, pool, b, [&](std::uint32_t) { ++active; });
    for_each_row(world.grid.patches, pool, b, body.removed_here, [&](std::uint32_t row) {
      const bool failed = pool.columns.component(pool.at.failed)[row] > 0.0;
      CHECK_EQUAL(failed, all >= active);
      ++all;
      CHECK(seen[m].insert(row).second && ids.insert(pool.id[row]).second, row);
      CHECK(pool.id[row] < body.count, row);
    });
    CHECK_EQUAL(active, body.active());
    CHECK_EQUAL(all, body.count);
  }
  for (std::size_t m = 0; m < seen.size(); ++m) CHECK_EQUAL(seen[m].size(), world.pools[m].count());
  CHECK(patches_of<D>(world.grid.patches, 3).empty());
}

/// Room is lent by the memory of the nodes, and where that is too small taken once for all.
template <int D>
void check_room(Report& report) {
  Scattered<D> world(5, basis_id<Linear>, false, 50);
  const std::span<std::byte> idle = world.grid.nodes.idle();
  CHECK(world.scratch.room(world.grid, idle.size(), idle.size()) == idle.data());
  CHECK_EQUAL(world.scratch.bytes(), std::size_t{0});
  std::byte* const own = world.scratch.room(world.grid, idle.size() + 1, 3 * idle.size());
  CHECK(own < idle.data() || own >= idle.data() + idle.size());
  CHECK(world.scratch.bytes() >= 3 * idle.size(), world.scratch.bytes());
  CHECK(world.scratch.room(world.grid, 2 * idle.size(), 3 * idle.size()) == own);
}

}  // namespace

void test_pool(Report& report) {
  check_pool<2>(report);
  check_pool<3>(report);
  check_room<2>(report);
  check_room<3>(report);
  for (const std::uint32_t n : {0u, 1u, 1000u}) CHECK(room_for(n) > n && spare_room(n) > 0, n);
}
