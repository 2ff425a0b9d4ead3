#pragma once
// The same bodies twice: in a domain, for the stages, and in the reference step.
#include <limits>
#include <random>
#include <stdexcept>

#include "mpm/contact/candidates.hpp"
#include "mpm/particles/add_columns.hpp"
#include "mpm/particles/make_body.hpp"
#include "mpm/reference/absorb.hpp"
#include "mpm/reference/averaging.hpp"
#include "mpm/reference/body_forces.hpp"
#include "mpm/reference/contact.hpp"
#include "mpm/reference/filter.hpp"
#include "mpm/reference/loads.hpp"
#include "mpm/reference/prescribed.hpp"
#include "mpm/reference/touch.hpp"
#include "mpm/reference/works.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/step/scheme.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm::testing {

inline constexpr double cell_size = 0.5;  // [m]
inline constexpr double own_step = 0.7;   // the step over that of the material

/// What a test chooses; all else is at random.
template <int D>
struct Choice {
  BasisId basis = basis_id<Linear>;
  double edge = 0.7;  // of the particles at the start [cells]
  bool contact = false;
  bool springs = false;                  // part the bodies in contact, else impulses
  bool load = false;                     // a pressure and a traction on the second body
  bool body_force = false;               // on the second body
  BodyKind kind = BodyKind::deformable;  // of the first body
  bool damping = false;                  // of the motion and the material of those that deform
  double pic_rate = 0.0;                 // [1/s]
  double flip_share = 1.0;
  TransferId transfer = Transfers::id_of<Flip>();
  int filter_order = 1;
  std::int64_t filter_every = 1;
  bool averages = false;  // volumes over cells
  bool flows = false;     // a gas, which the reference step does not have
  std::array<Wall, std::size_t{2} * D> walls{};
};

template <int D>
struct Twin {
  Domain<D> domain;
  reference::Step<D> reference;
  std::mt19937_64 random{7};
  double edge;

  explicit Twin(const Choice<D>& choice) : edge(choice.edge) {
    TileGrid<D>& grid = domain.grid;
    grid.cell_size = reference.h = cell_size;
    grid.basis = choice.basis;
    grid.walls.exist = true;
    for (std::size_t a = 0; a < D; ++a) {
      grid.walls.cells[a] = box_cells;
      for (std::size_t side = 0; side < 2; ++side)
        grid.walls.face[a][side] = choice.walls[2 * a + side];
      grid.walls.friction[a][0] = 0.2 + 0.1 * static_cast<double>(a);
      grid.walls.friction[a][1] = 0.4;
    }
    grid.walls.odd_at_fixed = odd_at_fixed_walls(choice.basis);
    reference.walls = grid.walls;
    grid.has_dashpots = grid.walls.absorb();
    grid.has_wall_springs = grid.walls.touch();
    reference.S = shape(choice.basis, edge);
    reference.box = choice.basis == basis_id<Gimp> ? half_width(choice.basis, edge) : 0.0;
    reference.spline = choice.basis == basis_id<QuadraticBSpline>;
    domain.time_step = reference.dt = 1e-5;
    domain.step_before = reference.dt_before = 0.9e-5;
    domain.pic_rate = choice.pic_rate;
    domain.transfer = choice.transfer;
    domain.flip_share = domain.flip_share_of_gases = choice.flip_share;
    domain.filter_order = choice.filter_order;
    domain.filter_every = choice.filter_every;
    const bool flips =
        choice.transfer != Transfers::id_of<Pic>() && choice.transfer != Transfers::id_of<Apic>();
    // AFLIP's share is one of the material's own step.
    const double own = choice.transfer == Transfers::id_of<Aflip>() ? own_step : 1.0;
    reference.pic =
        flips ? own * (1.0 - choice.flip_share) + choice.pic_rate * domain.time_step : 1.0;
    if (is_affine(choice.transfer)) reference.moment = grid.affine_moment();
    for (int a = 0; a < D; ++a) domain.gravity[a] = reference.g[a] = 1e4 * any();
    domain.contact_settings.enabled = choice.contact;
    domain.contact_settings.detection = Detections::id_of<VelocityDetection>();
    domain.contact_settings.normal = NormalRules::id_of<PairNormal>();
    domain.contact_settings.friction = 0.3;
    domain.contact_settings.response = choice.springs ? Response::springs : Response::impulses;
    reference.springs = choice.springs;
    reference.edge = [edge = edge](double volume) {
      using T = Batch<contact_lanes>;
      return particle_edge<D>(T(volume), edge * cell_size)[0];
    };
    reference.mu = 0.3;
    domain.threads.resize(1);
    if (choice.averages) reference.averages = reach_of(choice.basis).own_node;
    add_material(choice.damping ? 1e-5 : 0.0, choice.averages, choice.flows);
    domain.pools[0].fastest = own_step * 0.5 * cell_size / domain.time_step;
    for (int k = 0; k < 2; ++k) add_body(k, k == 0 ? choice.kind : BodyKind::deformable);
    if (choice.body_force) add_body_force();
    if (choice.damping) add_damping();
    fill_pools(domain.pools, domain.materials, domain.bodies, grid.patches);
    for (Patch<D>& patch : grid.patches) disturb(patch);  // one a body, the rows as they were given
    if (choice.load)
      for (const LoadKind kind : {LoadKinds::id_of<Pressure>(), LoadKinds::id_of<Traction>()})
        add_load(kind);
    build_cell_lists(grid, domain.bodies, domain.pools, domain.threads, domain.list_scratch);
    list_kinds(domain);
    if (domain.has_contact())
      connect_tiles(domain.contact, grid, domain.bodies, domain.contact_settings.response);
    domain.sums.resize(grid.patches.size());
    domain.face_parts.resize(grid.patches.size());
    start_ledger();
  }

  /// What the time loop does before and after the stages of a step.
  void begin_step() {
    domain.time_after = domain.time + domain.time_step;
    for (const std::size_t b : domain.prescribed)
      domain.bodies[b].motion->begin_step(domain.time, domain.time_after);
    begin_prescribed_motions(reference);
  }
  void end_step() {
    reference.t = domain.time = domain.time_after;
    ++domain.step;
  }

  static std::function<reference::ShapeValue(double)> shape(BasisId basis, double edge) {
    if (basis == basis_id<Linear>) return reference::linear;
    if (basis == basis_id<QuadraticBSpline>) return reference::quadratic;
    if (basis == basis_id<Gimp>) return [edge](double d) { return reference::gimp(d, 0.5 * edge); };
    throw std::logic_error("a basis without its function in reference/shape.hpp");
  }

 private:
  static constexpr int box_cells = D == 2 ? 11 : 7;  // along an axis: more than one tile
  static constexpr std::size_t particles = 60;
  static constexpr double density = 1000.0, E = 1e9, nu = 0.3;

  double any() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }
  void add_material(double beta, bool averages, bool flows) {
    MaterialChoice choice;
    choice.volume_averaging = averages;
    choice.density = density;
    choice.strength = {"elastic", {{"E", E}, {"nu", nu}}};
    if (flows) {
      choice.strength = {"fluid", {}};
      choice.eos = ModelChoice{"ideal_gas", {{"gamma", 1.4}, {"E0", E}}};
    }
    choice.damping = flows ? 0.0 : beta;
    domain.materials.push_back(make_material(choice));
    domain.pools.push_back(
        make_pool(domain.materials[0], domain.grid, columns_of(domain.transfer)));
  }
  /// Two bodies that overlap: the second begins at two fifths of the box along x.
  void add_body(int k, BodyKind kind) {
    std::vector<double> x, v;
    for (std::size_t i = 0; i < particles; ++i)
      for (int a = 0; a < D; ++a) {
        const double span = a == 0 ? 0.6 : 1.0, from = a == 0 && k == 1 ? 0.4 : 0.0;
        x.push_back(cell_size * box_cells * (from + span * 0.5 * (1.0 + any())));
        v.push_back(100.0 * any());
      }
    const double volume = std::pow(edge * cell_size, D);
    Body<D> body =
        make_body<D>("body", domain.materials[0], domain.pools[0], x, v, std::array{volume});
    body.kind = kind;
    if (!body.deforms()) body.stiffness = std::numeric_limits<double>::infinity();
    reference::Body<D>& other = reference.bodies.emplace_back();
    other.kind = kind;
    other.material = Elastic::of(E, nu, density);
    other.beta = domain.materials[0].damping.beta;
    if (body.is_prescribed()) prescribe(body, other);
    domain.bodies.push_back(std::move(body));
  }
  /// A motion and a spin that are other ones in every step.
  void prescribe(Body<D>& body, reference::Body<D>& other) {
    body.motion = std::make_unique<PrescribedMotion>();
    Vector3 centre = Vector3::zero();
    for (int a = 0; a < D; ++a) {
      body.motion->velocity[static_cast<std::size_t>(a)] = any_function(100.0);
      centre[a] = cell_size * (1.0 + any());
    }
    for (std::size_t a = D == 2 ? 2 : 0; a < 3; ++a) body.motion->spin[a] = any_function(100.0);
    body.motion->start(centre, domain.time);
    other.velocity = body.motion->velocity;
    other.spin = body.motion->spin;
    other.motion.centre = centre;
    for (std::size_t a = 0; a < 3; ++a) {
      other.motion.velocity.c[a] = other.velocity[a].at(reference.t);
      other.motion.spin.c[a] = other.spin[a].at(reference.t);
    }
  }
  TimeFunction any_function(double size) {
    TimeFunction f(size * any());
    f.amplitude = size * any();
    f.frequency = 2e4;  // five steps
    f.phase = 3.0 * any();
    return f;
  }
  /// On every third particle of the second body, so that some carry pieces of several loads, some
  /// far from the particle.
  void add_load(LoadKind kind) {
    SurfaceLoad<D>& load = domain.loads.emplace_back();
    load.body = 1;
    load.kind = kind;
    for (TimeFunction& value : load.value) value = any_function(1e8);
    reference::Load<D>& other = reference.loads.emplace_back();
    other.body = 1;
    other.pressure = kind == LoadKinds::id_of<Pressure>();
    other.value = load.value;
    ParticlePool<D>& pool = domain.pools[0];
    pool.piece.resize(pool.count(), 0);
    for (std::uint32_t i = 0; i < particles; ++i) {
      if (random() % 3 != 0) continue;
      SurfacePiece<D> piece;
      piece.load = static_cast<int>(domain.loads.size()) - 1;
      piece.particle = i;
      for (int a = 0; a < D; ++a) {
        piece.area[a] = any() * std::pow(edge * cell_size, D - 1);
        piece.arm[a] = cell_size * any();
      }
      piece.size = (1.5 + 0.5 * any()) * norm(piece.area);
      std::uint32_t& first = pool.piece[domain.grid.patches[1].begin + i];
      piece.next = std::exchange(first, static_cast<std::uint32_t>(pool.pieces.size() + 1));
      pool.pieces.push_back(piece);
      other.pieces.push_back({i, piece.size, piece.area, piece.arm});
    }
  }
  /// b_a = s sin(3 x_a + X_0 + 1e5 t) y, s as large as gravity, the phase within its step: three
  /// steps are 3 radians.
  void add_body_force() {
    constexpr double size = 1e4;
    BodyForce<D>& force = domain.body_forces.emplace_back();
    for (std::size_t a = 0; a < D; ++a)
      force.value[a] = Expression({{"number", 3.0},
                                   {std::string(expression_variables[a]), 0.0},
                                   {"multiply", 0.0},
                                   {"X", 0.0},
                                   {"add", 0.0},
                                   {"number", 1e5},
                                   {"t", 0.0},
                                   {"multiply", 0.0},
                                   {"add", 0.0},
                                   {"sin", 0.0},
                                   {"y", 0.0},
                                   {"multiply", 0.0},
                                   {"number", size},
                                   {"multiply", 0.0}});
    domain.bodies[1].force = 0;
    add_force_column(domain.pools[0]);
    if (force.is_of_start()) add_start_positions(domain.pools[0]);
    reference.bodies[1].force = [](const auto& x, const auto& X, double t) {
      Vec<double, D> b;
      for (int a = 0; a < D; ++a) b[a] = size * x[1] * std::sin(3.0 * x[a] + X[0] + 1e5 * t);
      return b;
    };
  }
  /// Each body its own, so strong that the drag of a step takes a good part of the velocity.
  void add_damping() {
    for (std::size_t k = 0; k < domain.bodies.size(); ++k) {
      if (!domain.bodies[k].deforms()) continue;
      domain.bodies[k].damping = static_cast<int>(domain.dampings.size());
      Damping& damping = domain.dampings.emplace_back();
      damping.now = {k == 0 ? 2e4 : 5e4, k == 0 ? 0.7 : 0.4};
      reference.bodies[k].alpha = damping.now.rate;
      reference.bodies[k].kappa = damping.now.local;
    }
  }
  void start_ledger() {
    Ledger& ledger = domain.ledger;
    for (const Patch<D>& patch : domain.grid.patches) {
      const ParticlePool<D>& pool = domain.pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch))
        ledger.start += kinetic_energy(pool, row, domain.grid.affine_moment());
    }
    ledger.start_prescribed(domain.bodies, domain.grid.patches, domain.pools,
                            *domain.grid.partition.comm);
    ledger.kinetic = ledger.start;
  }
  /// Volumes and stresses at random, and the same body for the reference.
  void disturb(const Patch<D>& patch) {
    ParticlePool<D>& pool = domain.pools[0];
    reference::Body<D>& other = reference.bodies[static_cast<std::size_t>(patch.body)];
    for (const std::uint32_t i : pool.rows(patch)) {
      pool.volume()[i] *= 1.0 + 0.2 * any();
      reference::Particle<D> p;
      for (int a = 0; a < D; ++a) {
        p.x[a] = pool.x(a)[i];
        p.v[a] = pool.v(a)[i];
      }
      p.X = p.x;
      p.m = pool.mass()[i];
      // Every second one so fast that it is kept from closing faster (step/transfer/apic.hpp).
      const double rate = i % 2 == 0 ? 200.0 : 2000.0;
      for (int c = 0; c < (pool.affine < 0 || !other.deforms() ? 0 : D * D); ++c)
        p.C[c / D][c % D] = pool.affine_part(c)[i] = static_cast<Storage>(rate * any());
      p.V = pool.volume()[i];
      for (int c = 0; c < Sym<double, D>::size; ++c)
        p.sigma.c[c] = pool.columns.rounded(pool.at.stress + c)[i] =
            static_cast<Storage>(other.deforms() ? 1e8 * any() : 0.0);
      other.particles.push_back(p);
    }
  }
};

}  // namespace mpm::testing
