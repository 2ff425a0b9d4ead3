// Bodies on nodes of their own: every stage does what the reference does, to rounding; the ledger
// closes; and a velocity that is given is that of the nodes.
#include <random>

#include "check.hpp"
#include "mpm/followers/follow.hpp"
#include "mpm/reference/kept_nodes.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/loads.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/prepare.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/step/kept_nodes.hpp"

namespace {

using namespace mpm;
using mpm::testing::Report;

constexpr double cell = 0.01, density = 1000.0, E = 1e7, nu = 0.3, dt = 1e-5;

/// Some number in -1..1, the same for the same node and component.
template <int D>
double scatter_of(const Index<D>& i, int a) {
  std::uint64_t seed = 77 + static_cast<std::uint64_t>(a);
  for (const std::int32_t k : i)
    seed = seed * 1000003u + static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1000);
  return std::uniform_real_distribution<double>(-1.0,
                                                1.0)(*std::make_unique<std::mt19937_64>(seed));
}
template <int D>
Vec<double, D> velocity_at_node(const Index<D>& i) {
  Vec<double, D> v;
  for (int a = 0; a < D; ++a) v[a] = 40.0 * scatter_of<D>(i, a);
  return v;
}

template <int D>
Settings settings_of(BasisId basis, Scheme scheme) {
  Settings s;
  s.grid.dimension = D;
  s.grid.cell_size = cell;
  s.grid.basis = basis;
  s.run.scheme = scheme;
  s.run.gravity[1] = TimeFunction(-2e4);
  if (second_moment(basis) == 0.0) s.run.transfer.word = Transfers::id_of<Flip>();
  s.run.short_wave_damping = second_moment(basis) == 0.0 ? 0.0 : 0.05;
  return s;
}

/// Particles at random over more than one tile, with stresses, on nodes that fly apart.
template <int D>
struct Pair {
  std::unique_ptr<Simulation<D>> simulation;
  reference::Step<D> step;
  reference::KeptNodes<D> other{step};
  std::mt19937_64 random{5};

  Pair(BasisId basis, Scheme scheme, bool averages)
      : simulation(std::make_unique<Simulation<D>>(settings_of<D>(basis, scheme))) {
    MaterialChoice choice;
    choice.density = density;
    choice.strength = {"elastic", {{"E", E}, {"nu", nu}}};
    choice.volume_averaging = averages;
    choice.in_body = true;
    const int material = add_material(*simulation, choice);
    add(material);
    add_a_load("pressure");
    add_a_load("traction");
    prepare(*simulation);
    Domain<D>& domain = simulation->domain;
    step.h = cell;
    step.dt = dt;
    step.g[1] = -2e4;
    const double edge = simulation->domain.bodies[0].mean_edge / cell;
    step.box = basis == basis_id<Gimp> ? half_width(basis, edge) : 0.0;
    step.spline = basis == basis_id<QuadraticBSpline>;
    step.S = basis == basis_id<QuadraticBSpline>
                 ? std::function<reference::ShapeValue(double)>(reference::quadratic)
                 : [edge](double d) { return reference::gimp(d, 0.5 * edge); };
    other.body.material = Elastic::of(E, nu, density);
    other.start(velocity_at_node<D>);
    if (averages) other.average();
    for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n) {
      for (int a = 0; a < D; ++a)
        block.records[n][velocity_at + a] =
            block.records[n][mass_at] > 0.0 ? velocity_at_node<D>(i)[a] : 0.0;
    });
    take_from_leading(domain, velocity_at);
    // Velocities are others than those by which it was known how the body turns.
    for (KeptSpin& turning : domain.kept_spins) turning.begun = false;
    domain.ledger.kept_ahead = 0.0;
    domain.ledger.kinetic = kinetic_energy(domain);
    domain.ledger.start = domain.ledger.kinetic + domain.ledger.internal;
  }

  double any() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }
  void add(int material) {
    constexpr std::size_t count = 80;
    std::vector<double> x, stress;
    for (std::size_t k = 0; k < count; ++k) {
      reference::Particle<D> p{};
      for (int a = 0; a < D; ++a) x.push_back(p.X[a] = cell * (4.0 + 4.0 * any()));
      p.x = p.X;
      p.V = std::pow(0.5 * cell, D);
      p.m = density * p.V;
      for (double& s : p.sigma.c) stress.push_back(s = 1e6 * any());
      other.body.particles.push_back(p);
    }
    const int body = add_body<D>(*simulation, "body", material, x, std::vector<double>(D, 0.0),
                                 std::array{std::pow(0.5 * cell, D)});
    set_state<D>(*simulation, body, "stress", stress);
  }
  /// On some particles, as large as the stress, with a period of some steps.
  void add_a_load(const std::string& kind) {
    std::array<TimeFunction, 3> value;
    for (TimeFunction& f : value) {
      f = TimeFunction(1e6 * any());
      f.amplitude = 1e6 * any();
      f.frequency = 0.2 / dt;
    }
    std::vector<std::uint32_t> particles;
    std::vector<double> areas, sizes, arms;
    reference::Load<D> load{0, kind == "pressure", {}, {}};
    std::copy_n(value.begin(), D, load.value.begin());
    for (std::uint32_t k = 0; k < other.body.particles.size(); k += 3) {
      reference::Piece<D> piece{k, 0.0, {}, {}};
      for (int a = 0; a < D; ++a) {
        areas.push_back(piece.a[a] = any() * std::pow(0.5 * cell, D - 1));
        arms.push_back(piece.middle[a] = 0.3 * cell * any());
      }
      sizes.push_back(piece.size = (1.5 + 0.5 * any()) * norm(piece.a));
      particles.push_back(k);
      load.pieces.push_back(piece);
    }
    other.loads.push_back(load);
    mpm::add_load<D>(*simulation, kind, 0, kind, value, {particles, areas, sizes, arms});
  }
  template <class F>
  void for_each_node(F&& f) {
    TileGrid<D>& grid = simulation->domain.grid;
    for (const Patch<D>& patch : grid.patches) {
      NodeBlock<D> block = grid.block(patch);
      for (int n = 0; n < block.count; ++n) f(index_of(grid, patch, n), block, n);
    }
  }

  void check_nodes(Report& report, int at, Vec<double, D> reference::Node<D>::* vector,
                   double size) {
    for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n) {
      const auto found = other.body.nodes.find(i);
      const bool any_mass = found != other.body.nodes.end();
      CHECK((any_mass && found->second.m > 0.0) == (block.records[n][mass_at] > 0.0));
      if (!any_mass) return;
      CHECK_CLOSE(block.records[n][mass_at], found->second.m, 1e-13 * density * std::pow(cell, D));
      for (int a = 0; a < D; ++a) {
        const double weight = at == force_at ? found->second.m * step.g[a] : 0.0;
        CHECK_CLOSE(block.records[n][at + a], (found->second.*vector)[a] - weight, size);
      }
    });
  }
  void check_displacements(Report& report) {
    for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n) {
      if (!(block.records[n][mass_at] > 0.0)) return;
      for (int a = 0; a < D; ++a)
        CHECK_CLOSE(block.displacements[n][a], other.u[i][a], 1e-9 * cell);
    });
  }
  void check_particles(Report& report) {
    const ParticlePool<D>& pool = simulation->domain.pools[0];
    const double tolerance = sizeof(Storage) == sizeof(double) ? 1e-9 : 1e-5;
    for (std::size_t row = 0; row < pool.count(); ++row) {
      const reference::Particle<D>& p = other.body.particles[pool.id[row]];
      for (int a = 0; a < D; ++a) CHECK_CLOSE(pool.x(a)[row], p.x[a], 1e-10 * cell);
      for (int k = 0; k < D * D; ++k)
        CHECK_CLOSE(pool.deformation_part(k)[row], other.F[pool.id[row]][k / D][k % D], 1e-10);
      CHECK_CLOSE(pool.volume()[row] / p.V, 1.0, 1e-10);
      CHECK_CLOSE(averaged_away(pool, static_cast<std::uint32_t>(row)), other.taken[pool.id[row]],
                  tolerance * E);
      for (int c = 0; c < Sym<double, D>::size; ++c)
        CHECK_CLOSE(double{pool.stress(c)[row]}, p.sigma.c[c], tolerance * E);
    }
  }
};

template <int D>
void check_stages(Report& report, BasisId basis, Scheme scheme, bool averages) {
  Pair<D> pair(basis, scheme, averages);
  Domain<D>& domain = pair.simulation->domain;
  domain.gravity[1] = -2e4;
  for (int k = 0; k < 4; ++k) {
    // Steps of different lengths, of which the first has none before it.
    domain.step_before = pair.step.dt_before = k == 0 ? 0.0 : domain.time_step;
    domain.time_step = pair.step.dt = dt * (1.0 + 0.3 * (k % 2));
    domain.shift_before = domain.shift;
    domain.shift = shift_between(domain.step_before, domain.time_step);
    domain.time_after = domain.time + domain.time_step;
    domain.step = 46 + k;  // The last is one in which short waves are damped.
    for (const Stage<D>& stage : pair.simulation->stages) {
      stage.run(domain);
      if (stage.name == "damp short waves in bodies" && k == 3 && second_moment(basis) > 0.0) {
        const double c = std::sqrt(E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / density);
        pair.other.damp_short_waves(50.0 * domain.time_step * c / cell, 0.05);
        pair.check_nodes(report, velocity_at, &reference::Node<D>::v, 1e-7);
      }
      if (stage.name == "exchange forces" || stage.name == "exchange momentum and forces") {
        pair.other.map_forces();
        pair.other.load_surfaces();
        pair.check_nodes(report, force_at, &reference::Node<D>::f,
                         1e-9 * E * std::pow(cell, D - 1));
      }
      if (stage.name == "turn bodies on nodes of their own") {
        pair.other.give_forces();
        pair.other.turn();
        pair.check_nodes(report, force_at, &reference::Node<D>::f,
                         1e-9 * E * std::pow(cell, D - 1));
      }
      if (stage.name == "advance nodes") {
        pair.other.advance_nodes();
        pair.check_nodes(report, velocity_at, &reference::Node<D>::v, 1e-7);
        pair.check_displacements(report);
      }
      if (stage.name == "update in the body") {
        pair.other.update();
        if (averages) continue;
        pair.check_particles(report);
      }
      if (averages && stage.name == "average pressure in bodies") {
        pair.other.average();
        pair.check_particles(report);
      }
    }
    pair.step.t = domain.time = domain.time_after;
    double kinetic = 0.0;
    for (const auto& [i, node] : pair.other.body.nodes)
      kinetic += 0.5 * node.m * dot(node.v, node.v);
    const Ledger& ledger = domain.ledger;
    CHECK_CLOSE((ledger.kinetic - ledger.kept_ahead) / kinetic, 1.0, 1e-9);
    CHECK_CLOSE(ledger.residual() / kinetic, 0.0, 1e-11);
  }
  // Far from where it was: what is tested is no small strain.
  double largest = 0.0;
  for (const Mat<double, D>& F : pair.other.F) largest = std::max(largest, std::abs(F[0][1]));
  CHECK(largest > 0.1);
}

/// Of a turning body the nodes have the velocities of a rigid motion, of one that is sheared that
/// of the shear; the particles what the nodes give them.
template <int D>
void check_velocities(Report& report, BasisId basis) {
  Simulation<D> simulation(settings_of<D>(basis, Scheme::usf));
  MaterialChoice choice;
  choice.density = density;
  choice.strength = {"elastic", {{"E", E}, {"nu", nu}}};
  choice.in_body = true;
  const int material = add_material(simulation, choice);
  std::vector<double> x, v;
  for (int k = 0; k < 8 * 8 * (D == 3 ? 8 : 1); ++k) {
    const int index[] = {k % 8, k / 8 % 8, k / 64};
    for (int a = 0; a < D; ++a) x.push_back(cell * (0.25 + 0.5 * index[a]));
    const double* const at = x.data() + x.size() - D;
    v.push_back(3.0 - 200.0 * at[1]);
    v.push_back(200.0 * at[0]);
    if (D == 3) v.push_back(1.0);
  }
  add_body<D>(simulation, "turning", material, x, v, std::array{std::pow(0.5 * cell, D)});
  prepare(simulation);
  Domain<D>& domain = simulation.domain;
  for (const Patch<D>& patch : domain.grid.patches)
    for_each_kept_node(domain.grid, patch, [&](double, const Vector3& place, const Vector3& w) {
      CHECK_CLOSE(w[0], 3.0 - 200.0 * place[1], 1e-10);
      CHECK_CLOSE(w[1], 200.0 * place[0], 1e-10);
    });
  // A shear, not rigid: at the corners .2 % of the largest velocity are missing.
  for (std::size_t k = 0; k < v.size(); k += D) v[k] = 100.0 * x[k + 1];
  set_velocity<D>(simulation, 0, v);
  const ParticlePool<D>& pool = domain.pools[0];
  for (std::size_t row = 0; row < pool.count(); ++row)
    CHECK_CLOSE(double{pool.v(0)[row]}, 100.0 * pool.x(1)[row], 2e-3 * 4.0);
  double sum = 0.0;
  for (std::size_t k = 0; k < v.size(); k += D) sum += v[k];
  CHECK_CLOSE(momentum(domain)[0], sum * density * std::pow(0.5 * cell, D), 1e-12);
}

}  // namespace

void test_kept_nodes(Report& report) {
  for (const BasisId basis : {basis_id<QuadraticBSpline>, basis_id<Gimp>}) {
    for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl}) {
      for (const bool averages : {false, true}) {
        check_stages<2>(report, basis, scheme, averages);
        check_stages<3>(report, basis, scheme, averages);
      }
    }
    check_velocities<2>(report, basis);
    check_velocities<3>(report, basis);
  }
}
