// Lists that are updated while particles move, fail and come back to tiles that were empty: every
// particle is once in the list of its cell, and those that have failed are in none.
#include <random>
#include <set>

#include "check.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/make_body.hpp"

namespace {

using namespace mpm;

constexpr std::uint32_t particles = 60;

template <int D>
struct MovingWorld {
  Threads threads;
  TileGrid<D> grid;
  ListScratch<D> scratch;
  std::vector<Body<D>> bodies;
  std::vector<ParticlePool<D>> pools;
  Removed eroded, outflow;

  /// Three bodies, the first and the last of one material.
  MovingWorld(std::mt19937_64& random, int thread_count, bool bonded) : threads(thread_count) {
    grid.cell_size = 0.5;
    grid.bonded = bonded;
    grid.outflow_box.exist = true;  // so that there are the columns that particles which leave need
    for (int a = 0; a < D; ++a) {
      grid.outflow_box.lower[a] = -1e3;
      grid.outflow_box.upper[a] = 1e3;
    }
    const Material material =
        make_material({1.0, {"elastic", {{"E", 1.0}, {"nu", 0.2}}}, {}, {}, {}});
    for (int m = 0; m < 2; ++m) pools.push_back(make_pool(material, grid));
    std::uniform_real_distribution<double> place(0.0, 6.0);  // over several tiles
    const std::vector<double> at_rest(D, 0.0), volume{1.0};
    for (int b = 0; b < 3; ++b) {
      std::vector<double> x(std::size_t{particles} * D);
      for (double& c : x) c = place(random);
      bodies.push_back(make_body<D>("b", material, pools[0], x, at_rest, volume));
      bodies.back().material = b == 1 ? 1 : 0;
    }
    fill_pools(pools, {material, material}, bodies, grid.patches);
    place_anchor(grid, bodies, pools);
    build_cell_lists(grid, bodies, pools, threads, scratch);
  }
  ParticlePool<D>& pool_of(int body) {
    return pools[static_cast<std::size_t>(bodies[static_cast<std::size_t>(body)].material)];
  }
  std::vector<std::uint32_t> rows_of(int body) {
    std::vector<std::uint32_t> rows;
    for_each_row(grid.patches, pool_of(body), body,
                 bodies[static_cast<std::size_t>(body)].removed_here,
                 [&](std::uint32_t row) { rows.push_back(row); });
    return rows;
  }
};

template <int D>
void check_updated(mpm::testing::Report& report, MovingWorld<D>& world, int round) {
  std::vector<std::set<std::uint32_t>> seen(world.pools.size());
  std::vector<std::size_t> listed(world.bodies.size(), 0);
  for (const Patch<D>& patch : world.grid.patches) {
    const auto b = static_cast<std::size_t>(patch.body);
    const auto m = static_cast<std::size_t>(world.bodies[b].material);
    const ParticlePool<D>& pool = world.pools[m];
    CHECK(patch.count <= patch.room && patch.begin + patch.room <= pool.used, round, b);
    listed[b] += patch.count;
    patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) {
        const std::uint32_t row = pool.order[k];
        Index<D> cell = Tile<D>::cell_index(c);
        for (std::size_t a = 0; a < D; ++a) cell[a] += world.grid.first_cell(patch.tile)[a];
        CHECK(world.grid.cell_of(pool.position_of(row)) == cell, round, patch.body, row);
        CHECK(k == begin || pool.id[pool.order[k - 1]] < pool.id[row], round, k);
        CHECK(seen[m].insert(row).second, round, patch.body, row);
      }
    });
  }
  for (std::size_t m = 0; m < world.pools.size(); ++m) {
    const ParticlePool<D>& pool = world.pools[m];
    CHECK(pool.used <= pool.order.size(), round, m);
    for (const RemovedRow& removed : pool.removed) {
      CHECK(seen[m].insert(removed.row).second, round, m, removed.row);
      CHECK(pool.columns.component(pool.at.failed)[removed.row] > 0.0, round, removed.row);
    }
    CHECK_EQUAL(seen[m].size(), pool.count());
  }
  for (std::size_t b = 0; b < listed.size(); ++b) CHECK_EQUAL(listed[b], world.bodies[b].active());
}

/// The lists of all bodies in the end.
template <int D>
std::vector<std::uint32_t> check_rounds(mpm::testing::Report& report, int thread_count,
                                        bool bonded) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> move(-2.0, 2.0);
  MovingWorld<D> world(random, thread_count, bonded);
  check_updated(report, world, -1);
  std::size_t failed = 0;
  for (int round = 0; round < 60; ++round) {
    const auto moved = static_cast<int>(random() % 3);  // the other bodies stay as they are
    ParticlePool<D>& pool = world.pool_of(moved);
    const std::vector<std::uint32_t> other = world.rows_of((moved + 1) % 3);
    for (Patch<D>& patch : world.grid.patches) {
      if (patch.body != moved || random() % 2 == 0) continue;
      patch.left_cell = true;
      for (const std::uint32_t row : pool.rows(patch)) {
        for (int a = 0; a < D; ++a)
          if (random() % 3 == 0) pool.x(a)[row] += move(random);
        if (random() % 80 != 0) continue;
        pool.columns.component(pool.at.failed)[row] = static_cast<double>(FailureAction::erode);
        ++failed;
      }
    }
    update_cell_lists(world.grid, world.bodies, world.pools, world.threads, world.scratch,
                      &world.eroded, &world.outflow);
    check_updated(report, world, round);
    CHECK(other == world.rows_of((moved + 1) % 3), round);
    world.scratch.moved = {0, 1, 2};
    if (round % 10 == 9)
      sort_disordered(world.grid, world.bodies, world.pools, world.threads, 0.0, world.scratch);
  }
  CHECK(failed > 10, failed);
  CHECK_EQUAL(world.eroded.count, failed);
  CHECK_EQUAL(world.outflow.count, std::size_t{0});
  std::vector<std::uint32_t> lists;
  for (int b = 0; b < 3; ++b)
    for (const std::uint32_t row : world.rows_of(b)) lists.push_back(row);
  return lists;
}

/// The same lists with one thread and with three, and if bodies share their nodes.
template <int D>
void check_threads(mpm::testing::Report& report) {
  const auto lists = check_rounds<D>(report, 1, false);
  CHECK(check_rounds<D>(report, 3, false) == lists);
  CHECK(check_rounds<D>(report, 2, true) == lists);
}

}  // namespace

void test_update_cell_lists(mpm::testing::Report& report) {
  check_threads<2>(report);
  check_threads<3>(report);
}
