// Sorting puts the rows of a body in the order of its lists, among the places that they had, and
// changes nothing else: every particle keeps all that is its own, and nobody else is touched.
#include <algorithm>

#include "check.hpp"
#include "particles/scattered.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// All that a row holds: the components of the columns, its number and its piece.
template <int D>
std::vector<double> all_of(const ParticlePool<D>& pool, std::uint32_t row) {
  std::vector<double> numbers{double(pool.id[row]), double(pool.piece[row])};
  for (int c = 0; c < pool.columns.component_count(); ++c)
    numbers.push_back(pool.columns.value(c, row));
  return numbers;
}

/// The rows of a body, in the order of its lists.
template <int D>
std::vector<std::uint32_t> rows_of(const Scattered<D>& world, int body) {
  std::vector<std::uint32_t> rows;
  for_each_active_row(world.grid.patches, world.pools[pool_number(world.bodies, body)], body,
                      [&](std::uint32_t row) { rows.push_back(row); });
  return rows;
}

/// What these rows hold, one after another.
template <int D>
std::vector<std::vector<double>> content(const ParticlePool<D>& pool,
                                         const std::vector<std::uint32_t>& rows) {
  std::vector<std::vector<double>> all;
  all.reserve(rows.size());
  for (const std::uint32_t row : rows) all.push_back(all_of(pool, row));
  return all;
}

template <int D>
void check_body(Report& report, Scattered<D>& world, int body) {
  const std::size_t m = pool_number(world.bodies, body);
  ParticlePool<D>& pool = world.pools[m];
  std::vector<std::uint32_t> rows = rows_of(world, body), others;
  for (std::uint32_t row = 0; row < pool.count(); ++row)
    if (std::ranges::find(rows, row) == rows.end()) others.push_back(row);
  const auto before = content(pool, rows), before_of_others = content(pool, others);
  Body<D>& sorted = world.bodies[static_cast<std::size_t>(body)];
  sort_columns(world.grid, sorted, patches_of<D>(world.grid.patches, body), pool, world.threads,
               world.scratch);
  CHECK_EQUAL(sorted.moved, std::size_t{0});
  CHECK(content(pool, rows_of(world, body)) == before, body);
  CHECK(content(pool, others) == before_of_others, body);
  std::ranges::sort(rows);
  CHECK(rows_of(world, body) == rows, body);
  for (const Patch<D>& patch : patches_of<D>(world.grid.patches, body))
    if (patch.count > 0) CHECK_EQUAL(patch.first_row, pool.rows(patch)[0]);
}

template <int D>
void check_rounds(Report& report, bool some_fail) {
  Scattered<D> world(9, basis_id<Linear>, false, 60);
  for (ParticlePool<D>& pool : world.pools)
    for (int c = D; c < pool.columns.component_count(); ++c)  // all but the position
      pool.columns.with_component(c, [&]<class Number>(Number* column) {
        for (std::size_t row = 0; row < pool.count(); ++row)
          column[row] = static_cast<Number>(world.any(0.0, 1.0));  // nobody fails by it
      });
  bool disordered = false;
  for (int round = 0; round < 4; ++round) {
    world.move(2.0);
    if (some_fail) world.fail_some();
    world.update();
    for (int body = 0; body < 3; ++body) {
      disordered = disordered || !std::ranges::is_sorted(rows_of(world, body));
      check_body(report, world, body);
    }
  }
  CHECK(disordered);
  CHECK_EQUAL(world.eroded.count > 5, some_fail);
}

}  // namespace

void test_sort_columns(Report& report) {
  for (const bool some_fail : {false, true}) {  // so that their rows lie in sequence, and not
    check_rounds<2>(report, some_fail);
    check_rounds<3>(report, some_fail);
  }
}
