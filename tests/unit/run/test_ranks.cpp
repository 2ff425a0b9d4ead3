// Any number of ranks makes the same bits: particles, history and ledger after some steps of a body
// that bends, spins and crosses tiles.
#include <thread>

#include "check.hpp"
#include "mpm/comm/threads_comm.hpp"
#include "mpm/run/advance.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/columns.hpp"
#include "mpm/run/prepare.hpp"

namespace {

using namespace mpm;

/// What a test chooses.
struct Choice {
  Scheme scheme = Scheme::usf;
  BasisId basis = basis_id<QuadraticBSpline>;
  TransferId transfer = Transfers::id_of<Aflip>();
  bool bonded = false;  // two bodies
  bool walls = false;
};

/// What a run ends with, the same on all ranks.
struct Outcome {
  std::vector<double> numbers;  // of particles by body, column and number, of its history
};

template <int D>
void build(Simulation<D>& simulation, const Choice& choice) {
  const int material =
      add_material(simulation, {1000.0, {"neo_hookean", {{"K", 1e7}, {"G", 3e6}}}, {}, {}});
  for (int b = 0; b < (choice.bonded ? 2 : 1); ++b) {
    std::vector<double> x, v;
    Index<D> low, high;
    low.fill(0);
    high.fill(D == 2 ? 39 : 15);
    for_each_index<D>(low, high, [&](const Index<D>& i) {
      for (std::size_t a = 0; a < D; ++a)
        x.push_back(0.25 + 0.5 * i[a] + (a == 0 ? 8.0 * (D == 2 ? 2.5 : 1.0) * b : 0.0));
      const double* at = &x[x.size() - D];
      v.push_back(-20.0 * at[1]);
      v.push_back(20.0 * at[0]);
      if (D == 3) v.push_back(30.0 + at[1]);
    });
    add_body(simulation, "body", material, x, v, std::array{std::pow(0.5, D)});
  }
}

/// The columns of a body, gathered from all ranks.
template <int D>
Outcome outcome_of(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  Comm& comm = *domain.grid.partition.comm;
  Outcome outcome;
  for (std::size_t b = 0; b < domain.bodies.size(); ++b)
    for (const ColumnInfo& info : columns(domain, static_cast<int>(b))) {
      const auto width =
          static_cast<std::size_t>(column_components(domain, static_cast<int>(b), info.name));
      std::vector<double> values(domain.bodies[b].count * width);
      copy_column(domain, static_cast<int>(b), info.name, values);
      // Each rank has some, and 0 for the others.
      std::vector<std::int64_t> bits(values.size());
      for (std::size_t k = 0; k < bits.size(); ++k)
        bits[k] = std::bit_cast<std::int64_t>(values[k]);
      comm.all_sum(bits);
      for (const std::int64_t word : bits) outcome.numbers.push_back(std::bit_cast<double>(word));
    }
  for (const double x : simulation.history.take()) outcome.numbers.push_back(x);
  return outcome;
}

template <int D>
Settings settings_of(const Choice& choice) {
  Settings settings;
  settings.grid.dimension = D;
  settings.grid.cell_size = 1.0;
  settings.grid.basis = choice.basis;
  settings.run.scheme = choice.scheme;
  settings.run.transfer.word = choice.transfer;
  settings.contact.bonded = choice.bonded;
  settings.run.energy_growth_limit = 1e9;
  if (choice.walls) {
    settings.grid.box_cells = {60, 60, D == 3 ? 60 : 0};
    settings.grid.walls[0] = Wall::slip;
    settings.grid.walls[2] = Wall::fixed;
    settings.grid.walls[3] = Wall::absorbing;
  }
  return settings;
}

template <int D>
Outcome run_on(const Choice& choice, int ranks) {
  constexpr int steps = 60;
  std::vector<Outcome> outcomes(static_cast<std::size_t>(ranks));
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(ranks));
  const auto world = std::make_shared<ThreadsWorld>(ranks);
  {
    std::vector<std::jthread> threads;
    for (int rank = 0; rank < ranks; ++rank)
      threads.emplace_back([&, rank] {
        ThreadsComm comm(world, rank);
        try {
          Simulation<D> simulation(settings_of<D>(choice), &comm);
          build(simulation, choice);
          prepare(simulation);
          advance(simulation, steps, 1e9, nullptr);
          outcomes[static_cast<std::size_t>(rank)] = outcome_of(simulation);
        } catch (const std::exception& error) {
          comm.fail(error.what());
          errors[static_cast<std::size_t>(rank)] = std::current_exception();
        }
      });
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  for (const Outcome& outcome : outcomes)
    if (outcome.numbers != outcomes[0].numbers) throw std::logic_error("ranks tell other numbers");
  return outcomes[0];
}

template <int D>
void check(mpm::testing::Report& report, const Choice& choice) {
  fprintf(stderr, "D%d scheme %d walls %d\n", D, (int)choice.scheme, choice.walls);
  const Outcome alone = run_on<D>(choice, 1);
  for (const int ranks : {2, 3, 4, 8}) {
    fprintf(stderr, "ranks %d\n", ranks);
    const Outcome some = run_on<D>(choice, ranks);
    std::size_t different = 0;
    for (std::size_t k = 0; k < alone.numbers.size(); ++k)
      different += alone.numbers[k] != some.numbers[k];
    CHECK_EQUAL(some.numbers.size(), alone.numbers.size());
    CHECK_EQUAL(different, 0u);
  }
}

template <int D>
void check_all(mpm::testing::Report& report) {
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl})
    for (const bool walls : {false, true})
      check<D>(report, {.scheme = scheme, .bonded = walls, .walls = walls});
}

}  // namespace

void test_ranks(mpm::testing::Report& report) {
  check_all<2>(report);
  check_all<3>(report);
}
