// A node that several patches of a body hold has the same bits in each, however long the body turns
// and is hit: copies that differ by rounding would drift apart and tear it.
#include <map>

#include "mpm/run/advance.hpp"
#include "step/surface_twin.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Two blocks over corners of tiles that hit each other off the middle and fly on turning.
template <int D>
SurfacesGiven<D> hit_off_the_middle(double restitution) {
  SurfacesGiven<D> given;
  given.restitution = restitution;
  given.friction = 0.3;
  given.walls[2] = Wall::contact;
  TurnedBlock<D> lower, upper;
  for (TurnedBlock<D>* const block : {&lower, &upper}) {
    block->velocity = Vec<double, D>::zero();
    for (int a = 0; a < D; ++a) {
      block->size[a] = 5.0;
      block->centre[a] = a == 1 ? 9.8 : 16.3;
    }
    block->angle = 0.3;
  }
  upper.size[0] = 4.0;
  upper.centre[0] = 15.1;
  upper.centre[1] = 16.3;
  upper.velocity[1] = -10.0;
  given.bodies = {{{lower}}, {{upper}, 2e7, 0.2, 1500.0}};
  return given;
}

template <int D>
void check_copies(Report& report, double restitution) {
  const SurfaceTwin<D> twin(hit_off_the_middle<D>(restitution));
  Simulation<D>& simulation = *twin.simulation;
  advance(simulation, 300, 1e9);
  TileGrid<D>& grid = simulation.domain.grid;
  using Motion = std::array<double, 2 * std::size_t{D}>;
  std::map<std::pair<int, Index<D>>, Motion> first;
  int copies = 0, different = 0;
  for (const Patch<D>& patch : grid.patches) {
    const NodeBlock<D> block = grid.block(patch);
    for (int n = 0; n < block.count; ++n) {
      Motion motion;
      for (std::size_t a = 0; a < D; ++a) {
        motion[a] = block.displacements[n][a];
        motion[D + a] = block.records[n][velocity_at + a];
      }
      const auto [at, is_new] = first.try_emplace({patch.body, index_of(grid, patch, n)}, motion);
      if (is_new) continue;
      ++copies;
      different += at->second != motion;
    }
  }
  CHECK(simulation.domain.surfaces.touching_max > 0, D);
  CHECK(simulation.domain.kept_spins.size() == 2, D);
  CHECK(copies > 8, copies, D);
  CHECK_EQUAL(different, 0);
}

}  // namespace

void test_copies_of_nodes(mpm::testing::Report& report) {
  for (const double restitution : {1.0, 0.5}) {
    check_copies<2>(report, restitution);
    check_copies<3>(report, restitution);
  }
}
