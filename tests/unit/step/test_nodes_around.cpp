// The nodes between which a particle lies, whatever the basis: the one at the lower corner is the
// last that is not beyond the particle along any axis, and all are in the patch's block.
#include "check.hpp"
#include "mpm/step/nodes_around.hpp"
#include "particles/scattered.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

template <int D>
void check_basis(Report& report, BasisId basis) {
  Scattered<D> world(6, basis, false, 100);
  world.move(2.0);  // some onto faces of cells and between them
  world.update();
  for (const Patch<D>& patch : world.grid.patches) {
    const ParticlePool<D>& pool = world.pool_of(patch);
    for_each_cell(world.grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k) {
        const NodesAround<D> around(world.grid, pool, patch, cell, cell.rows[k]);
        const Vec<double, D> lower = world.grid.position_of(around.lower);
        Index<D> in_block = around.lower, upper;
        for (std::size_t a = 0; a < D; ++a) {
          const int axis = static_cast<int>(a);
          const double way = pool.x(axis)[cell.rows[k]] - lower[axis];
          CHECK(way >= 0.0 && way < world.grid.cell_size, way);
          CHECK_CLOSE(around.place[a], around.lower[a] + way / world.grid.cell_size, 1e-12);
          in_block[a] -= world.grid.first_cell(patch.tile)[a];
          upper[a] = in_block[a] + 1;
        }
        CHECK(patch.shape.holds(in_block) && patch.shape.holds(upper), cell.rows[k]);
        CHECK_EQUAL(around.first, patch.shape.node(in_block));
      }
    });
  }
}

}  // namespace

void test_nodes_around(Report& report) {
  Bases::for_each([&](BasisId basis, const auto&) {
    check_basis<2>(report, basis);
    check_basis<3>(report, basis);
  });
}
