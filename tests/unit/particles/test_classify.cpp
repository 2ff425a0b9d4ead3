// Where particles are now, a few at a time: what one at a time says.
#include "check.hpp"
#include "mpm/particles/classify.hpp"
#include "particles/scattered.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// f(place in the patch's list, row, cell of the list).
template <int D, class F>
void for_each_listed(const ParticlePool<D>& pool, const Patch<D>& patch, F&& f) {
  patch.for_each_cell([&](int cell, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t k = begin; k < end; ++k) f(k - patch.begin, pool.order[k], cell);
  });
}

/// Marks and counts of all patches after `move`; how many particles are outside.
template <int D>
std::size_t check_cells(Report& report, Scattered<D>& world) {
  std::size_t outside = 0;
  for (const Patch<D>& patch : world.grid.patches) {
    const ParticlePool<D>& pool = world.pool_of(patch);
    std::vector<std::uint8_t> marks(patch.count + 1, 77);
    const std::size_t changed = note_cells(world.grid, pool, patch, marks.data());
    std::size_t expected = 0;
    for_each_listed(pool, patch, [&](std::uint32_t k, std::uint32_t row, int cell) {
      const int now = world.mark_of(patch, row);
      CHECK_EQUAL(int{marks[k]}, now);
      expected += now != cell;
      outside += now == CellMark::outside;
    });
    CHECK_EQUAL(changed, expected);
    CHECK_EQUAL(int{marks.back()}, 77);  // no further
  }
  return outside;
}

/// Who fails is eroded, else who is out of the box has left: of a rigid body all or none.
template <int D>
void check_removed(Report& report, Scattered<D>& world) {
  OutflowBox<D>& box = world.grid.outflow_box;
  for (int a = 0; a < D; ++a) {
    box.lower[a] = 0.5;
    box.upper[a] = 5.5;
  }
  world.bodies[1].kind = world.bodies[2].kind = BodyKind::rigid;
  world.bodies[2].leaves = true;
  std::size_t eroded = 0, left = 0;
  for (const Patch<D>& patch : world.grid.patches) {
    const Body<D>& body = world.bodies[static_cast<std::size_t>(patch.body)];
    const ParticlePool<D>& pool = world.pool_of(patch);
    std::vector<std::uint8_t> marks(patch.count);
    note_cells(world.grid, pool, patch, marks.data());
    const std::vector<std::uint8_t> before = marks;
    const std::size_t more = note_removed(world.grid, body, pool, patch, marks.data());
    std::size_t expected = 0;
    for_each_listed(pool, patch, [&](std::uint32_t k, std::uint32_t row, int cell) {
      int mark = before[k];
      if (body.deforms() ? !box.holds(pool.position_of(row)) : body.leaves) mark = CellMark::left;
      const double failed = pool.columns.component(pool.at.failed)[row];
      if (failed >= static_cast<double>(FailureAction::erode)) mark = CellMark::eroded;
      CHECK_EQUAL(int{marks[k]}, mark);
      expected += mark != before[k] && before[k] == cell;
      eroded += mark == CellMark::eroded;
      left += mark == CellMark::left;
    });
    CHECK_EQUAL(more, expected);
  }
  CHECK(eroded > 5 && left > 5, eroded, left);
}

/// Without the column of failure and without a region, nobody is looked at.
template <int D>
void check_nobody(Report& report) {
  TileGrid<D> grid;
  grid.cell_size = 1.0;
  const Material material =
      make_material({1.0, {"elastic", {{"E", 1.0}, {"nu", 0.2}}}, {}, {}, {}});
  const ParticlePool<D> pool = make_pool(material, grid);
  CHECK(pool.at.failed < 0);
  CHECK_EQUAL(note_removed(grid, Body<D>{}, pool, Patch<D>{}, nullptr), std::size_t{0});
}

template <int D>
void check_classes(Report& report) {
  for (const BasisId basis : {basis_id<Linear>, basis_id<Gimp>}) {
    Scattered<D> world(3, basis, false, 80);
    CHECK_EQUAL(check_cells(report, world), std::size_t{0});
    world.move(2.0);
    CHECK(check_cells(report, world) > 20);
    world.fail_some();
    check_removed(report, world);
  }
  check_nobody<D>(report);
}

}  // namespace

void test_classify(Report& report) {
  check_classes<2>(report);
  check_classes<3>(report);
}
