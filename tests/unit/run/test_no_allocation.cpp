// A step takes nothing from the heap once the run is warm: in 2D and 3D, all schemes, contact of
// three bodies, two threads.
#include <cstdlib>
#include <vector>

#include "check.hpp"
#include "count_allocations.hpp"
#include "mpm/run/advance.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/loads.hpp"
#include "mpm/run/prepare.hpp"
#include "step/surface_twin.hpp"

namespace {

using namespace mpm;

/// Does the counter see what it must see?
void check_counter(mpm::testing::Report& report) {
  auto counted = [](auto&& f) {
    const std::size_t before = mpm::testing::allocation_count();
    f();
    return mpm::testing::allocation_count() - before;
  };
  volatile std::size_t n = 100;
  void* volatile kept = nullptr;  // so that the compiler cannot leave an allocation out
  CHECK_EQUAL(counted([] {}), 0u);
  CHECK(counted([&] {
          std::vector<double> v(n);
          kept = v.data();
        }) > 0);
  CHECK(counted([&] {
          kept = std::aligned_alloc(64, 64 * n);
          std::free(kept);
        }) > 0);
  CHECK(counted([&] {
          kept = std::malloc(n);
          std::free(kept);
        }) > 0);
}

struct Block {
  std::array<int, 3> lower, upper;  // cells
};

/// Eight (2D: four) particles a cell, the cells being 1 m wide; the positions and the number of
/// values.
std::vector<double> fill(const Block& block, int dimension) {
  std::vector<double> positions;
  const int layers = dimension == 3 ? 2 * block.upper[2] : 1;
  for (int k = dimension == 3 ? 2 * block.lower[2] : 0; k < layers; ++k)
    for (int j = 2 * block.lower[1]; j < 2 * block.upper[1]; ++j)
      for (int i = 2 * block.lower[0]; i < 2 * block.upper[0]; ++i) {
        positions.push_back(0.25 + 0.5 * i);
        positions.push_back(0.25 + 0.5 * j);
        if (dimension == 3) positions.push_back(0.25 + 0.5 * k);
      }
  return positions;
}

struct Motion3 {
  const char* name;
  std::array<double, 3> velocity, gravity;
  bool plate;  // the body below shakes as prescribed
  TransferId transfer = Transfers::id_of<Flip>();
  Response response = Response::impulses;
};

/// Two blocks side by side on a third, elastic and neo-Hookean (E about 1e7 Pa, waves of 100 m/s),
/// so that nodes of three bodies exist from the start.
template <int D>
std::unique_ptr<Simulation<D>> stack(Scheme scheme, const Motion3& motion, int threads) {
  Settings settings;
  settings.grid.dimension = D;
  settings.grid.cell_size = 1.0;
  settings.run.scheme = scheme;
  settings.run.transfer.word = motion.transfer;
  settings.grid.basis = scheme == Scheme::usf ? basis_id<Linear> : basis_id<Gimp>;
  if (is_affine(motion.transfer)) settings.grid.basis = basis_id<QuadraticBSpline>;
  settings.contact.response = motion.response;
  settings.run.cfl = 0.3;
  for (std::size_t a = 0; a < 3; ++a) settings.run.gravity[a] = motion.gravity[a];
  if (motion.gravity[1] != 0.0) {
    settings.grid.box_cells = {40, 40, D == 3 ? 40 : 0};
    settings.grid.walls[2] = Wall::fixed;
    settings.grid.walls[1] = Wall::absorbing;
    settings.grid.walls[0] = Wall::contact;
    settings.grid.wall_friction[0] = 0.3;
    settings.grid.outflow = true;
    settings.grid.outflow_lower = {-100.0, -100.0, -100.0};
    settings.grid.outflow_upper = {100.0, 100.0, 100.0};
  }
  settings.contact.friction = 0.3;
  settings.execution.threads = threads;
  settings.run.energy_growth_limit = 1e9;
  auto made = std::make_unique<Simulation<D>>(settings);
  Simulation<D>& simulation = *made;
  const BulkViscosity viscosity{1.5, 0.06};
  const int rubber = add_material(
      simulation, {1000.0, {"neo_hookean", {{"K", 1e7}, {"G", 3e6}}}, {}, {}, viscosity});
  const int solid =
      add_material(simulation, {1000.0, {"elastic", {{"E", 1e7}, {"nu", 0.3}}}, {}, {}, viscosity});
  const Block blocks[] = {
      {{8, 0, 8}, {20, 5, 11}}, {{8, 5, 8}, {14, 9, 11}}, {{14, 5, 8}, {20, 9, 11}}};
  for (int b = 0; b < 3; ++b) {
    const double volume[] = {D == 3 ? 0.125 : 0.25};
    const std::span<const double> velocity(motion.velocity.data(), static_cast<std::size_t>(D));
    add_body(simulation, "block", b == 0 ? solid : rubber, fill(blocks[b], D), velocity, volume);
  }
  if (motion.plate) {
    TimeFunction shaking(0.0), turning(0.0);
    shaking.amplitude = 2.0;
    shaking.frequency = 5.0;
    turning.times = {0.0, 0.1, 0.2};
    turning.values = {0.0, 1e-3, -1e-3};
    set_motion(simulation, 0, {shaking, 0.0, 0.0}, {0.0, 0.0, turning}, {14.0, 2.0, 9.5});
  } else if (motion.gravity[1] != 0.0) {
    const std::uint32_t particles[] = {0, 1, 2};
    const std::vector<double> vectors(3 * static_cast<std::size_t>(D), 0.25);
    const double sizes[] = {0.5, 0.5, 0.5};
    add_load(simulation, "load", 0, "pressure", {TimeFunction(10.0)},
             {particles, vectors, sizes, vectors});
  }
  prepare(simulation);
  return made;
}

template <int D>
std::size_t allocations_of(Simulation<D>& simulation, std::int64_t steps) {
  const std::size_t before = mpm::testing::allocation_count();
  advance(simulation, steps, 1e9);
  return mpm::testing::allocation_count() - before;
}

// Together through many tiles; and resting on a floor, sliding, the contacts loaded in every step,
// with a pressure, in a region that is kept, before a wall that absorbs.
constexpr Motion3 motions[] = {
    {"through tiles", {40.0, 40.0, 40.0}, {0.0, 0.0, 0.0}, false},
    {"on a floor", {0.0, 0.0, 0.0}, {0.0, -3.0, 0.0}, false},
    {"on a plate", {0.0, 0.0, 0.0}, {0.0, -3.0, 0.0}, true},
    {"on a plate, filtered", {0.0, 0.0, 0.0}, {0.0, -3.0, 0.0}, true, Transfers::id_of<Xpic>()},
    {"through tiles, springs",
     {40.0, 40.0, 40.0},
     {0.0, 0.0, 0.0},
     false,
     Transfers::id_of<Aflip>(),
     Response::springs},
    {"on a plate, springs",
     {0.0, 0.0, 0.0},
     {0.0, -3.0, 0.0},
     true,
     Transfers::id_of<Aflip>(),
     Response::springs}};

template <int D>
void check_steps(mpm::testing::Report& report, Scheme scheme, const Motion3& motion) {
  const int threads = scheme == Scheme::musl && D == 2 ? 2 : 1;
  const auto simulation = stack<D>(scheme, motion, threads);
  // Warm: the blocks have crossed two tiles, and been everywhere on the cells and tiles that they
  // will be; or they have swung on the floor.
  const int warm = D == 2 ? 200 : 100;
  advance(*simulation, warm, 1e9);
  const std::size_t call = allocations_of(*simulation, 0);  // of the call itself
  // A thread that gets its first contact late, on a busy machine, makes its own scratch then.
  std::size_t steps = 1;
  for (int turn = 0; turn < threads && steps > 0; ++turn)
    steps = allocations_of(*simulation, warm / 2) - call;
  CHECK(steps == 0, steps, D, static_cast<int>(scheme), motion.name);
  const Domain<D>& domain = simulation->domain;
  CHECK(domain.step >= warm + warm / 2);
  CHECK(domain.contact.counts.overlapped > 0, D, motion.name);
  CHECK_EQUAL(domain.contact.counts.bodies_max, 3);
}

/// Two blocks on nodes of their own, one on the other on a floor, with friction and restitution,
/// and a plate that is moved along the side of one: contact between surfaces. Lists of near points
/// are made anew from time to time, which takes memory; here they are not.
template <int D>
void check_surfaces(mpm::testing::Report& report, double restitution) {
  mpm::testing::SurfacesGiven<D> given;
  given.walls[2] = Wall::contact;
  given.friction = 0.3;
  given.restitution = restitution;
  given.shaking = 0.0;
  given.gravity = -2000.0;
  mpm::testing::TurnedBlock<D> lower, upper, side;
  for (mpm::testing::TurnedBlock<D>* const block : {&lower, &upper, &side}) {
    block->velocity = Vec<double, D>::zero();
    for (int a = 0; a < D; ++a) {
      block->centre[a] = 10.0;
      block->size[a] = 4.0;
    }
  }
  lower.centre[1] = 2.001;
  upper.centre[1] = 6.002;
  side.centre[0] = 14.02;
  side.centre[1] = 3.0;
  given.bodies = {{{lower}}, {{upper}}, {{side}}};
  given.bodies[2].kind = BodyKind::prescribed;
  given.bodies[2].velocity[0] = TimeFunction(-0.02);
  const mpm::testing::SurfaceTwin<D> twin(given);
  Simulation<D>& simulation = *twin.simulation;
  advance(simulation, 600, 1e9);
  const std::size_t call = allocations_of(simulation, 0);
  // A stretch of steps in which lists stay.
  const double& age = simulation.domain.surfaces.age_of_lists;
  std::size_t steps = 1;
  for (int turn = 0; turn < 20 && steps > 0; ++turn) {
    const double before = age;
    const std::size_t made = allocations_of(simulation, 30) - call;
    if (age > before) steps = made;
  }
  CHECK(simulation.domain.surfaces.touching_max > 0, D);
  CHECK(steps == 0, steps, D, restitution);
}

}  // namespace

void test_no_allocation(mpm::testing::Report& report) {
  check_counter(report);
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl})
    for (const Motion3& motion : motions) {
      check_steps<2>(report, scheme, motion);
      check_steps<3>(report, scheme, motion);
    }
  for (const double restitution : {1.0, 0.5}) {
    check_surfaces<2>(report, restitution);
    check_surfaces<3>(report, restitution);
  }
}
