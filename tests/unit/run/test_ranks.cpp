// Any number of ranks makes the same bits, wherever the tiles go: particles, history and ledger of
// bodies that bend, spin and cross tiles, with all that may act on them.
#include <functional>
#include <random>
#include <thread>

#include "check.hpp"
#include "mpm/comm/threads_comm.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/run/advance.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/columns.hpp"
#include "mpm/run/contact_rows.hpp"
#include "mpm/run/grain_rows.hpp"
#include "mpm/run/loads.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/part_rows.hpp"
#include "mpm/run/prepare.hpp"
#include "mpm/run/save.hpp"
#include "mpm/run/warnings.hpp"

namespace {

using namespace mpm;

// With a sanitizer each run takes 20 times as long and more. What ranks do hardly depends on the
// dimension: in 3D there is one case then.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

/// What a test chooses beside the default.
struct RankedCase {
  const char* name;
  std::function<void(Settings&)> set = [](Settings&) {};
  bool load = false, force = false, erodes = false;
  bool rigid = false, prescribed = false;  // the second body
  bool contact = false;
  bool settles = false;   // the first body; the others have velocities, and are held
  bool averages = false;  // volumes over cells
};

/// Particles along an edge of a block.
template <int D>
constexpr std::int32_t block_edge = D == 2 ? 23 : 9;

/// A block of particles, half a cell apart, that spins about the origin and flies.
template <int D>
void add_block(Simulation<D>& simulation, int material, double from, double speed) {
  std::vector<double> x, v;
  Index<D> low{}, high;
  high.fill(block_edge<D>);
  for_each_index<D>(low, high, [&](const Index<D>& i) {
    for (std::size_t a = 0; a < D; ++a) x.push_back(0.25 + 0.5 * i[a] + (a == 0 ? from : 0.0));
    const double* at = &x[x.size() - D];
    v.push_back(speed - 20.0 * at[1]);
    v.push_back(20.0 * (at[0] - from));
    if (D == 3) v.push_back(30.0 + at[1]);
  });
  add_body(simulation, "block", material, x, v, std::array{std::pow(0.5, D)});
}

template <int D>
void build(Simulation<D>& simulation, const RankedCase& choice) {
  MaterialChoice material{1000.0, {"neo_hookean", {{"K", 1e7}, {"G", 3e6}}}, {}, {}};
  material.volume_averaging = choice.averages;
  if (choice.erodes) material.failures = {{{"principal_stress", {{"limit", 1e6}}}, "erode"}};
  const int rubber = add_material(simulation, material);
  const ModelChoice elastic{"elastic", {{"E", 2e7}, {"nu", 0.2}}}, rigid{"rigid", {}};
  const int stone =
      add_material(simulation, {2000.0, choice.rigid ? rigid : elastic, {}, {}, {1.5, 0.06}});
  add_block(simulation, rubber, 0.0, 0.0);
  constexpr double length = 0.5 * block_edge<D>;
  add_block(simulation, stone, length + 0.5, 25.0);
  add_block(simulation, rubber, -length - 2.5, 60.0);
  if (choice.settles) {
    const std::size_t count = simulation.domain.bodies[0].count;
    set_velocity(simulation, 0, std::vector<double>(count * D, 0.0));
  }
  if (choice.prescribed) {
    TimeFunction shaking(10.0), turning(5.0);
    shaking.amplitude = 200.0;
    shaking.frequency = 50.0;
    set_motion(simulation, 1, {shaking, 0.0, 0.0}, {0.0, 0.0, turning}, {20.0, 7.0, 5.0});
  }
  if (choice.load)
    for (const char* kind : {"pressure", "traction", "force"}) {
      std::vector<std::uint32_t> particles(60);
      for (std::uint32_t k = 0; k < 60; ++k) particles[k] = 8 * k;
      const std::vector<double> sizes(60, 0.5), vectors(60 * std::size_t{D}, 0.3);
      add_load(simulation, kind, 0, kind, {TimeFunction(1e4), TimeFunction(2e4), TimeFunction(1e3)},
               {particles, vectors, sizes, vectors});
    }
  if (choice.force) {
    const Expression::Program along = {
        {"X", 0.0}, {"sin", 0.0}, {"number", 1e3}, {"multiply", 0.0}};
    add_body_force(simulation, {0, 2}, std::vector<Expression::Program>(D, along));
    add_damping(simulation, {0}, TimeFunction(20.0), TimeFunction(0.3));
  }
}

template <int D>
void gather(const Simulation<D>& simulation, std::vector<double>& numbers) {
  const Domain<D>& domain = simulation.domain;
  for (int b = 0; std::cmp_less(b, domain.bodies.size()); ++b)
    for (const ColumnInfo& info : columns(domain, b)) {
      const auto width = static_cast<std::size_t>(column_components(domain, b, info.name));
      std::vector<double> values(domain.body_at(b).count * width);
      copy_column(domain, Slices(domain.body_at(b).count), b, info.name, values);
      numbers.insert(numbers.end(), values.begin(), values.end());
    }
}

/// Other ranges of tiles, the same ones on all ranks.
template <int D>
void shuffle_owners(Simulation<D>& simulation, std::mt19937_64& random) {
  TileGrid<D>& grid = simulation.domain.grid;
  if (grid.partition.alone()) return;
  Owners<D> owners = grid.partition.owners;
  for (std::size_t r = 1; r < owners.first.size(); ++r) {
    Index<D> tile;
    for (std::int32_t& t : tile) t = static_cast<std::int32_t>(random() % 8);
    owners.first[r] = owners.place(tile);
  }
  std::ranges::sort(owners.first);
  take_owners(grid, owners);
}

/// Rounds of ten steps; other ranks go on from a state in the middle of them.
constexpr int rounds = 4, saved_after = 2;

/// The states that runs of some numbers of ranks have left, by rank 0.
struct States {
  bool saves = true;
  const std::vector<std::byte>* from = nullptr;  // what this run begins with
  std::vector<std::byte> left;
};

template <int D>
void save_to(Simulation<D>& simulation, std::vector<std::byte>& bytes) {
  simulation.timers.reset();
  save<D>(simulation, [&](std::span<std::byte> some) {
    bytes.insert(bytes.end(), some.begin(), some.end());
    return some.size();
  });
}

template <int D>
void restore_from(Simulation<D>& simulation, const std::vector<std::byte>& bytes) {
  std::size_t at = 0;
  const auto read = [&](std::span<std::byte> some) {
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), some.size(), some.begin());
    at += some.size();
    return some.size();
  };
  restore<D>(simulation, read, bytes.size());
}

template <int D>
std::vector<double> run_of(const RankedCase& choice, Comm& comm, States& states) {
  Settings settings;
  settings.grid.dimension = D;
  settings.grid.cell_size = 1.0;
  settings.grid.basis = basis_id<QuadraticBSpline>;
  settings.run.scheme = Scheme::usf;
  settings.run.transfer.word = Transfers::id_of<Aflip>();
  settings.run.energy_growth_limit = 1e9;
  settings.contact.enabled = choice.contact;
  settings.contact.response = Response::springs;
  settings.contact.friction = 0.3;
  settings.execution.balance_every = 7;
  choice.set(settings);
  Simulation<D> simulation(settings, &comm);
  build(simulation, choice);
  prepare(simulation);
  std::mt19937_64 random(3);
  std::vector<double> told;  // in the last round
  if (states.from != nullptr) restore_from(simulation, *states.from);
  for (int round = states.from != nullptr ? saved_after : 0; round < rounds; ++round) {
    if (round == saved_after && comm.rank() == 0) states.left.clear();
    if (round == saved_after && states.saves && !simulation.failure)
      save_to(simulation, states.left);
    advance(simulation, 10, 1e9, nullptr);
    const std::vector<double> contacts = contact_rows(simulation.domain);
    told = contacts;
    for (const double x : grain_rows(simulation.domain, contacts)) told.push_back(x);
    shuffle_owners(simulation, random);
  }
  std::vector<double> numbers = simulation.history.take();
  numbers.insert(numbers.end(), told.begin(), told.end());
  gather(simulation, numbers);
  const auto parts = part_sums(simulation.domain);
  for (const double x : part_rows(simulation.domain, parts)) numbers.push_back(x);
  for (const FaceRecord& face : face_records(simulation.domain))
    for (const double x : {face.force[0], face.force[1], face.impulse[0], face.impulse[1]})
      numbers.push_back(x);
  for (const double x : balance_row(simulation.domain.ledger.angular, angular_totals(parts)))
    numbers.push_back(x);
  for (const PairRecord& pair : simulation.domain.contact.records.of_all_ranks(comm))
    for (const double x : {pair.first_time, pair.first_gap, pair.first_normal[0],
                           pair.first_node[1], pair.force[0], pair.impulse[1], pair.friction_work})
      numbers.push_back(std::isnan(x) ? -1.0 : x);
  const ContactCounts& counts = simulation.domain.contact.counts;
  numbers.push_back(static_cast<double>(counts.overlapped_max +
                                        1000u * static_cast<std::size_t>(counts.bodies_max)));
  const RemovedSum eroded = sum_of(simulation.domain.eroded, comm);
  numbers.push_back(eroded.mass);
  for (const LoadRecord& load : load_records(simulation.domain)) numbers.push_back(load.area);
  for (const Warning& warning : warnings(simulation)) {
    numbers.push_back(static_cast<double>(warning.particle));
    for (const char c : warning.message) numbers.push_back(c);
  }
  if (simulation.failure)
    for (const char c : simulation.failure->message) numbers.push_back(c);
  return numbers;
}

/// What the first rank ends with; what all tell is the same.
template <int D>
std::vector<double> run_on(const RankedCase& choice, int ranks, States& states) {
  const auto count = static_cast<std::size_t>(ranks);
  std::vector<std::vector<double>> outcomes(count);
  std::vector<std::exception_ptr> errors(count);
  std::vector<States> of_ranks(count, states);
  const auto world = std::make_shared<ThreadsWorld>(ranks);
  {
    std::vector<std::jthread> threads;
    threads.reserve(count);
    for (std::size_t rank = 0; rank < count; ++rank)
      threads.emplace_back([&, rank] {
        ThreadsComm comm(world, static_cast<int>(rank));
        try {
          outcomes[rank] = run_of<D>(choice, comm, of_ranks[rank]);
        } catch (const std::exception& error) {
          comm.fail(error.what());
          errors[rank] = std::current_exception();
        }
      });
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  states.left = std::move(of_ranks[0].left);
  return outcomes[0];
}

void check_same(mpm::testing::Report& report, const std::vector<double>& some,
                const std::vector<double>& alone, const char* what, int ranks, int dimension) {
  std::size_t same = 0;
  for (std::size_t k = 0; k < alone.size() && k < some.size(); ++k) same += alone[k] == some[k];
  CHECK_EQUAL(some.size(), alone.size());
  CHECK(same == alone.size(), what, ranks, dimension, same, alone.size());
}

/// Three ranks, or the other numbers.
enum class RankCounts { three, others };

template <int D>
void check(mpm::testing::Report& report, const RankedCase& choice, RankCounts counts) {
  States first;
  const std::vector<double> alone = run_on<D>(choice, 1, first);
  for (const int ranks : {2, 3, 8}) {
    if ((ranks == 3) != (counts == RankCounts::three)) continue;
    try {
      const bool saves = ranks == 3;
      States states{saves, nullptr, {}};
      check_same(report, run_on<D>(choice, ranks, states), alone, choice.name, ranks, D);
      if (!saves) continue;
      // The state in the middle is the same one, and any number of ranks goes on from it.
      const auto other = std::ranges::mismatch(states.left, first.left).in1 - states.left.begin();
      CHECK(states.left == first.left, choice.name, ranks, D, states.left.size(), other);
      if (first.left.empty()) continue;
      States again{false, &states.left, {}};
      check_same(report, run_on<D>(choice, D == 2 ? 1 : 4, again), alone, choice.name, -ranks, D);
    } catch (const std::exception& error) {
      CHECK(false, choice.name, ranks, D, error.what());
    }
  }
}

void put_walls(Settings& settings) {
  settings.grid.box_cells = {60, 60, settings.grid.dimension == 3 ? 60 : 0};
  settings.grid.walls = {Wall::free, Wall::slip, Wall::fixed, Wall::absorbing, Wall::contact};
  settings.grid.wall_friction[4] = 0.3;
}

std::vector<RankedCase> choices() {
  std::vector<RankedCase> all;
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl})
    all.push_back({"scheme", [=](Settings& s) { s.run.scheme = scheme; }});
  Bases::for_each([&](BasisId basis, const auto&) {
    all.push_back({"basis", [=](Settings& s) {
                     s.grid.basis = basis;
                     s.run.transfer.word = Transfers::id_of<Flip>();
                     s.run.scheme = Scheme::musl;
                     put_walls(s);
                   }});
  });
  Transfers::for_each([&](TransferId transfer, const auto&) {
    all.push_back({"transfer", [=](Settings& s) {
                     s.run.transfer.word = transfer;
                     s.run.transfer.every = 3;
                     put_walls(s);
                   }});
  });
  all.push_back({"bonded", [](Settings& s) {
                   s.contact.enabled = s.contact.bonded = true;
                   put_walls(s);
                 }});
  all.push_back({.name = "springs", .contact = true});
  all.push_back(
      {.name = "springs, walls and a tool", .set = put_walls, .prescribed = true, .contact = true});
  all.push_back({.name = "springs and a rigid body", .rigid = true, .contact = true});
  all.push_back({.name = "springs and erosion", .erodes = true, .contact = true});
  const auto impulses = [](Settings& s) {
    s.contact.response = Response::impulses;
    s.grid.basis = basis_id<Gimp>;
    s.run.transfer.word = Transfers::id_of<Flip>();
    s.run.scheme = Scheme::musl;
    put_walls(s);
  };
  all.push_back({.name = "impulses", .set = impulses, .contact = true});
  all.push_back(
      {.name = "impulses and a tool", .set = impulses, .prescribed = true, .contact = true});
  all.push_back(
      {.name = "impulses and a rigid body", .set = impulses, .rigid = true, .contact = true});
  all.push_back({.name = "bonded pair beside springs",
                 .set = [](Settings& s) { set_law(s.contact, 0, 1, {0.0, true}); },
                 .contact = true});
  all.push_back({.name = "rigid body bonded, beside impulses",
                 .set =
                     [=](Settings& s) {
                       impulses(s);
                       set_law(s.contact, 0, 1, {0.0, true});
                     },
                 .rigid = true,
                 .contact = true});
  all.push_back({.name = "impulses and erosion", .set = impulses, .erodes = true, .contact = true});
  all.push_back({.name = "impulses that are released",
                 .set =
                     [=](Settings& s) {
                       impulses(s);
                       s.run.transfer.pic_rate = 10.0;
                     },
                 .contact = true});
  all.push_back({.name = "planes that are kept",
                 .set =
                     [=](Settings& s) {
                       impulses(s);
                       s.contact.normal_refresh_distance = 0.1;
                     },
                 .contact = true});
  all.push_back({.name = "velocity rule",
                 .set =
                     [=](Settings& s) {
                       impulses(s);
                       s.contact.detection = Detections::id_of<VelocityDetection>();
                       s.contact.normal = NormalRules::id_of<PairNormal>();
                     },
                 .contact = true});
  all.push_back({.name = "loads", .load = true, .averages = true});
  all.push_back({.name = "forces and damping", .force = true});
  all.push_back({.name = "erosion", .load = true, .erodes = true});
  all.push_back({"outflow", [](Settings& s) {
                   s.grid.outflow = true;
                   s.grid.outflow_lower = {-30.0, 1.0, -100.0};
                   s.grid.outflow_upper = {20.0, 100.0, 100.0};
                 }});
  all.push_back({.name = "rigid", .set = put_walls, .rigid = true});
  all.push_back({.name = "prescribed", .set = put_walls, .prescribed = true});
  all.push_back({"coarsening", [](Settings& s) {
                   s.grid.coarsening.emplace();
                   s.grid.coarsening->tiles = 5;
                   s.grid.coarsening->times = 1;
                 }});
  const auto settle = [](Settings& s) {
    s.run.settle.emplace();
    s.run.settle->longest = 0.02;
    s.run.gravity[1] = TimeFunction(-9.81);
    put_walls(s);
  };
  all.push_back({.name = "settling", .set = settle, .settles = true});
  all.push_back({.name = "settling beside rigid bodies",
                 .set = settle,
                 .rigid = true,
                 .contact = true,
                 .settles = true});
  const auto threads = [](Settings& s) { s.execution.threads = 2; };
  all.push_back({.name = "threads", .set = threads, .rigid = true, .contact = true});
  all.push_back({.name = "rigid bodies that leave",
                 .set =
                     [=](Settings& s) {
                       impulses(s);
                       s.grid.outflow = true;
                       s.grid.outflow_lower = {-100.0, -100.0, -100.0};
                       s.grid.outflow_upper = {25.0, 100.0, 100.0};
                     },
                 .rigid = true,
                 .contact = true});
  return all;
}

void check_all(mpm::testing::Report& report, RankCounts counts) {
  const std::vector<RankedCase> all = choices();
  for (const RankedCase& choice : all) {
    check<2>(report, choice, counts);
    if (!sanitized || &choice == &all.front()) check<3>(report, choice, counts);
  }
}

}  // namespace

void test_ranks(mpm::testing::Report& report) { check_all(report, RankCounts::three); }

void test_two_and_eight_ranks(mpm::testing::Report& report) {
  check_all(report, RankCounts::others);
}
