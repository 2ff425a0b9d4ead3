// Lists that are mended while particles move, fail and come back to tiles that were empty: every
// particle is once in the list of its cell, and those that have failed stand behind all others.
#include <random>
#include <set>

#include "check.hpp"
#include "mpm/particles/lists.hpp"

namespace {

using namespace mpm;

constexpr std::uint32_t particles = 60;

template <int D>
Body<D> make_body(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(0.0, 6.0);  // over several tiles
  Body<D> body;
  body.position = body.columns.add("position", "m", D);
  body.at.velocity = body.columns.add("velocity", "m/s", D, Kept::rounded);
  body.at.mass = body.columns.add("mass", "kg", 1);
  body.at.recoverable = body.columns.add("recoverable_energy", "J/m^3", 1);
  body.at.failed = body.columns.add("failed", "1", 1);
  body.columns.allocate(particles);
  body.initial_density = 1.0;
  for (std::uint32_t i = 0; i < particles; ++i) {
    for (int a = 0; a < D; ++a) {
      body.x(a)[i] = place(random);
      body.v(a)[i] = 0.0;
    }
    body.mass()[i] = 1.0;
    body.columns.component(body.at.recoverable)[i] = 0.0;
    body.columns.component(body.at.failed)[i] = 0.0;
    body.id.push_back(i);
  }
  return body;
}

template <int D>
void check_lists(mpm::testing::Report& report, const TileGrid<D>& grid,
                 const std::vector<Body<D>>& bodies, int round) {
  std::vector<std::set<std::uint32_t>> seen(bodies.size());
  for (const Patch<D>& patch : grid.patches) {
    const auto b = static_cast<std::size_t>(patch.body);
    patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) {
        const std::uint32_t row = bodies[b].order[k];
        Vec<double, D> x;
        for (int a = 0; a < D; ++a) x[a] = bodies[b].x(a)[row];
        Index<D> cell = Tile<D>::cell_index(c);
        for (std::size_t a = 0; a < D; ++a) cell[a] += grid.first_cell(patch.tile)[a];
        CHECK(grid.cell_of(x) == cell, round, patch.body, row);
        CHECK(seen[b].insert(row).second, round, patch.body, row);
      }
    });
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    CHECK_EQUAL(seen[b].size(), bodies[b].active());
    for (std::size_t k = bodies[b].active(); k < bodies[b].count(); ++k) {
      const std::uint32_t row = bodies[b].order[k];
      CHECK(seen[b].insert(row).second, round, b, row);
      CHECK(bodies[b].columns.component(bodies[b].at.failed)[row] > 0.0, round, b, row);
    }
  }
}

/// The lists of all bodies in the end.
template <int D>
std::vector<std::uint32_t> check_rounds(mpm::testing::Report& report, int thread_count,
                                        bool bonded) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> move(-2.0, 2.0);
  Threads threads(thread_count);
  TileGrid<D> grid;
  grid.cell_size = 0.5;
  grid.bonded = bonded;
  std::vector<Body<D>> bodies;
  bodies.reserve(3);
  for (int b = 0; b < 3; ++b) bodies.push_back(make_body<D>(random));
  ListScratch<D> scratch;
  Gone<D> eroded, left;
  make_lists(grid, bodies, threads, scratch);
  check_lists(report, grid, bodies, -1);
  std::size_t failed = 0;
  for (int round = 0; round < 30; ++round) {
    const auto moved = static_cast<int>(random() % 3);  // the other bodies stay as they are
    Body<D>& body = bodies[static_cast<std::size_t>(moved)];
    const std::vector<std::uint32_t> other =
        bodies[static_cast<std::size_t>((moved + 1) % 3)].order;
    for (Patch<D>& patch : grid.patches) {
      if (patch.body != moved || random() % 2 == 0) continue;
      patch.left_cell = true;
      for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k) {
        const std::uint32_t row = body.order[k];
        for (int a = 0; a < D; ++a)
          if (random() % 3 == 0) body.x(a)[row] += move(random);
        if (random() % 40 != 0) continue;
        body.columns.component(body.at.failed)[row] = static_cast<double>(FailureAction::erode);
        ++failed;
      }
    }
    mend_lists(grid, bodies, threads, scratch, eroded, left);
    check_lists(report, grid, bodies, round);
    CHECK(other == bodies[static_cast<std::size_t>((moved + 1) % 3)].order, round);
    if (round % 10 == 9)
      for (Body<D>& each : bodies) sort_columns(grid, each, threads, scratch);
  }
  CHECK(failed > 10, failed);
  CHECK_EQUAL(eroded.count, failed);
  CHECK_EQUAL(left.count, std::size_t{0});
  std::vector<std::uint32_t> lists;
  for (const Body<D>& body : bodies)
    lists.insert(lists.end(), body.order.begin(), body.order.end());
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

void test_mend_lists(mpm::testing::Report& report) {
  check_threads<2>(report);
  check_threads<3>(report);
}
