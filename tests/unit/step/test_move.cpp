// Particles of a cell that move with given velocities: x + dt v, of those only; and whether any has
// left the cell.
#include <numeric>

#include "check.hpp"
#include "mpm/step/move.hpp"

namespace {

using namespace mpm;

/// In place of nodal fields: one velocity for all.
template <int D>
struct OneVelocity {
  Vec<double, D> v;
  template <int at, class Weights>
  auto vector(const Weights&) const {
    static_assert(at == velocity_at);
    Vec<Batch<4>, D> r;
    for (int a = 0; a < D; ++a) r[a] = Batch<4>(v[a]);
    return r;
  }
};

template <int D>
struct OneCell {
  static constexpr double h = 0.5, dt = 0.25;
  static constexpr std::uint32_t count = 7;  // a group of lanes and a part of one
  TileGrid<D> grid;
  ParticlePool<D> pool;
  std::vector<std::uint32_t> rows;
  CellRange<D> cell{};

  /// Every second row is in the cell, all in its middle.
  explicit OneCell(bool in_order) {
    grid.cell_size = h;
    for (int a = 0; a < D; ++a) grid.origin[a] = 1.0 + a;
    cell.cell.fill(-3);
    pool = make_pool();
    for (std::uint32_t k = 0; k < count; ++k) rows.push_back(in_order ? k : 2 * k);
    cell.rows = rows.data();
    cell.count = count;
  }
  ParticlePool<D> make_pool() {
    ParticlePool<D> made;
    made.position = made.columns.add("position", "m", D);
    made.columns.allocate(2 * count);
    for (int a = 0; a < D; ++a) std::fill_n(made.x(a), 2 * count, middle(a));
    return made;
  }
  double middle(int a) const { return grid.origin[a] + h * -2.5; }
  /// Does any leave when all go so far [cells]?
  bool leaves(const Vec<double, D>& way) {
    Moving<Batch<4>, D> moving(grid, pool, dt);
    for_each_group<4>(cell, [&](const auto& group) {
      moving.move(cell, group, OneVelocity<D>{(h / dt) * way}, nullptr);
    });
    Patch<D> patch;
    PatchSums<D> sums;
    moving.write(patch, sums);
    return patch.left_cell;
  }
};

template <int D>
void check_ways(mpm::testing::Report& report, bool in_order) {
  for (int axis = 0; axis < D; ++axis)
    for (const double size : {-0.51, -0.49, 0.0, 0.49, 0.51}) {
      Vec<double, D> way = Vec<double, D>::zero();
      way[axis] = size;
      OneCell<D> one(in_order);
      const bool left = one.leaves(way);
      CHECK_EQUAL(left, std::abs(size) > 0.5);
      for (std::uint32_t row = 0; row < 2 * OneCell<D>::count; ++row) {
        const bool moved = std::ranges::find(one.rows, row) != one.rows.end();
        for (int a = 0; a < D; ++a)
          CHECK_CLOSE(one.pool.x(a)[row], one.middle(a) + (moved ? one.h * way[a] : 0.0), 1e-15);
      }
    }
}

/// One alone, whichever it is, and the lower face is the cell's own.
template <int D>
void check_one(mpm::testing::Report& report, bool in_order) {
  for (std::uint32_t k = 0; k < OneCell<D>::count; ++k)
    for (const double x : {-3.0, -2.0, -3.25, -2.75}) {
      OneCell<D> one(in_order);
      one.pool.x(D - 1)[one.rows[k]] = one.grid.origin[D - 1] + one.h * x;
      const bool left = one.leaves(Vec<double, D>::zero());
      CHECK_EQUAL(left, !(x >= -3.0 && x < -2.0));
    }
}

}  // namespace

void test_move(mpm::testing::Report& report) {
  for (const bool in_order : {false, true}) {
    check_ways<2>(report, in_order);
    check_ways<3>(report, in_order);
    check_one<2>(report, in_order);
    check_one<3>(report, in_order);
  }
}
