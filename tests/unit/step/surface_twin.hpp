#pragma once
// Blocks with contact points on their surfaces, twice: as the stages have them, and in the
// reference step.
#include <functional>
#include <list>
#include <random>

#include "check.hpp"
#include "mpm/reference/bonds.hpp"
#include "mpm/reference/pressing.hpp"
#include "mpm/reference/restitution.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/prepare.hpp"
#include "mpm/run/surfaces.hpp"
#include "mpm/step/kept_nodes.hpp"

namespace mpm::testing {

/// Of a lattice of particles two along a cell, turned about its middle [cells, rad, m/s].
template <int D>
struct TurnedBlock {
  Vec<double, D> centre, size, velocity;
  double angle = 0.0;
};

/// A body of one block or of several that are apart.
template <int D>
struct BlocksGiven {
  std::vector<TurnedBlock<D>> blocks;
  double E = 1e7, nu = 0.3, density = 1000.0;
  BodyKind kind = BodyKind::deformable;
  std::array<TimeFunction, 3> velocity{}, spin{};  // where they are prescribed
  unsigned held_by = ~0u;                          // of the walls that hold what lies on them
  bool in_space = false;                           // its particles press others; the last body
};

template <int D>
struct SurfacesGiven {
  std::vector<BlocksGiven<D>> bodies;
  double friction = 0.0, restitution = 1.0;
  std::vector<std::tuple<int, int, PairLaw>> pairs{};
  std::array<Wall, 6> walls{};  // of a box of 24 cells
  std::array<double, 6> wall_friction{};
  double shaking = 2.0;   // of nodes at the start [m/s]
  double gravity = -2e3;  // along y [m/s^2]
  BasisId basis = basis_id<QuadraticBSpline>;
};

template <int D>
class SurfaceTwin {
 public:
  // Points in 3D are coarser, for the reference is slow.
  static constexpr double cell = 0.01, e = (D == 2 ? 0.25 : 0.5) * cell;

  std::unique_ptr<Simulation<D>> simulation;
  reference::Step<D> step;
  std::list<reference::KeptNodes<D>> kept;
  reference::Surfaces<D> surfaces{step, e};
  std::vector<reference::Bond<D>> bonds;
  reference::Pressing<D> pressing{surfaces};

  explicit SurfaceTwin(const SurfacesGiven<D>& given)
      : simulation(std::make_unique<Simulation<D>>(settings_of(given))) {
    step.bodies.reserve(given.bodies.size());
    step.h = cell;
    step.spline = given.basis == basis_id<QuadraticBSpline>;
    step.box = given.basis == basis_id<Gimp> ? 0.25 : 0.0;
    for (const BlocksGiven<D>& body : given.bodies) add(body);
    for (const auto& [a, b, law] : given.pairs) {
      set_pair_law(simulation->domain, a, b, law);
      surfaces.laws[{a, b}] = {law.friction, law.restitution, law.bonded};
    }
    surfaces.law = {given.friction, given.restitution, false};
    prepare(*simulation);
    Domain<D>& domain = simulation->domain;
    step.g[1] = domain.gravity[1] = given.gravity;
    step.walls = domain.grid.walls;
    step.S = given.basis == basis_id<Gimp>
                 ? [](double d) { return reference::gimp(d, 0.25); }
                 : std::function<reference::ShapeValue(double)>(reference::quadratic);
    for (reference::Body<D>& body : step.bodies)
      if (!body.prescribed()) body.motion = reference::motion_of(body.particles);
    start_nodes();
    bonds = reference::find_bonds(surfaces);
    surfaces.start();
    read_pressing();
    pressing.start();
    shake_nodes(given.shaking);
    find_points();
  }

  /// f(node, block, n, body) for the nodes of bodies on nodes of their own.
  template <class F>
  void for_each_node(F&& f) {
    TileGrid<D>& grid = simulation->domain.grid;
    for (const Patch<D>& patch : grid.patches) {
      if (!patch.keeps) continue;
      NodeBlock<D> block = grid.block(patch);
      for (int n = 0; n < block.count; ++n)
        if (block.records[n][mass_at] > 0.0)
          f(index_of(grid, patch, n), block, n, static_cast<std::size_t>(patch.body));
    }
  }

  /// Where the particles in space are by now, and how they move.
  void read_pressing() {
    const Domain<D>& domain = simulation->domain;
    for (const Patch<D>& patch : domain.grid.patches) {
      if (domain.body_of(patch).kind != BodyKind::deformable) continue;
      const ParticlePool<D>& pool = domain.pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch)) {
        reference::PressingParticle<D>& p = pressing.particles[pool.id[row]];
        p.x = pool.position_of(row);
        p.pressure = 0.0;
        for (int k = 0; k < 3; ++k) p.pressure -= pool.stress(k)[row] / 3.0;
        for (int a = 0; a < D; ++a) p.v[a] = pool.v(a)[row];
        p.now = pool.mass()[row] / pool.volume()[row];
      }
    }
  }

  /// Of each body the numbers of its contact points in the simulation.
  std::vector<std::vector<std::uint32_t>> points;

  std::mt19937_64 random{7};
  double any() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }

 private:
  static Settings settings_of(const SurfacesGiven<D>& given) {
    Settings s;
    s.grid.dimension = D;
    s.grid.cell_size = cell;
    s.grid.basis = given.basis;
    if (given.basis == basis_id<Gimp>) s.run.transfer.word = Transfers::id_of<Flip>();
    s.grid.walls = given.walls;
    s.grid.wall_friction = given.wall_friction;
    s.grid.box_cells = {24, 24, D == 3 ? 24 : 0};
    s.contact.friction = given.friction;
    s.contact.restitution = given.restitution;
    return s;
  }

  /// Where a place of a block comes to lie, turned about z, in 3D about x before that [m].
  static Vec<double, D> place_of(const TurnedBlock<D>& block, Vec<double, D> x) {
    const double c = std::cos(block.angle), s = std::sin(block.angle);
    if constexpr (D == 3) x = {x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]};
    const double x0 = x[0], x1 = x[1];
    x[0] = c * x0 - s * x1;
    x[1] = s * x0 + c * x1;
    return cell * (block.centre + x);
  }

  /// Out of a face of it.
  static Vec<double, D> normal_of(const TurnedBlock<D>& block, int axis, double side) {
    const Vec<double, D> origin = Vec<double, D>::zero();
    Vec<double, D> out = origin;
    out[axis] = side;
    return normalised(place_of(block, out) - place_of(block, origin));
  }

  void add(const BlocksGiven<D>& given) {
    const double volume = std::pow(0.5 * cell, D);
    MaterialChoice choice;
    choice.density = given.density;
    const bool deforms = given.kind == BodyKind::deformable;
    choice.strength = {"elastic", {{"E", given.E}, {"nu", given.nu}}};
    if (given.kind == BodyKind::rigid) choice.strength = {"rigid", {}};
    choice.in_body = deforms;
    if (given.in_space) choice.in_body = false;
    const int material = add_material(*simulation, choice);
    if (given.in_space) {
      add_pressing(given, material, volume);
      return;
    }
    reference::SurfaceBody<D> surface;
    if (deforms) {
      kept.push_back({step});
      surface.kept = &kept.back();
    } else {
      surface.whole = &step.bodies.emplace_back();
    }
    reference::Body<D>& body = deforms ? kept.back().body : step.bodies.back();
    body.kind = given.kind;
    body.held_by = given.held_by;
    body.material = Elastic::of(given.E, given.nu, given.density);
    std::vector<double> x, v;
    for (const TurnedBlock<D>& block : given.blocks)
      for_each_in(Vec<double, D>::zero() - 0.5 * block.size, block.size, 0.5, -1,
                  [&](const Vec<double, D>& at) {
                    reference::Particle<D> p{};
                    p.x = p.X = place_of(block, at);
                    p.v = block.velocity;
                    p.V = volume;
                    p.m = given.density * volume;
                    body.particles.push_back(p);
                    x.insert(x.end(), p.x.c, p.x.c + D);
                    v.insert(v.end(), p.v.c, p.v.c + D);
                  });
    const int number = add_body<D>(*simulation, "body", material, x, v, std::array{volume});
    if (given.kind == BodyKind::prescribed) prescribe(number, given, body);
    add_points(number, given, surface);
    surfaces.bodies.push_back(surface);
  }

  /// Particles alone, of a body in space.
  void add_pressing(const BlocksGiven<D>& given, int material, double volume) {
    std::vector<double> x, v;
    for (const TurnedBlock<D>& block : given.blocks)
      for_each_in(Vec<double, D>::zero() - 0.5 * block.size, block.size, 0.5, -1,
                  [&](const Vec<double, D>& at) {
                    const Vec<double, D> place = place_of(block, at);
                    x.insert(x.end(), place.c, place.c + D);
                    v.insert(v.end(), block.velocity.c, block.velocity.c + D);
                    reference::PressingParticle<D>& p = pressing.particles.emplace_back();
                    p.V0 = volume;
                    p.density = given.density;
                    const Elastic law = Elastic::of(given.E, given.nu, given.density);
                    p.M = law.lambda + 2.0 * law.G;
                  });
    add_body<D>(*simulation, "body", material, x, v, std::array{volume});
  }

  /// About the middle of its first block.
  void prescribe(int number, const BlocksGiven<D>& given, reference::Body<D>& body) {
    body.velocity = given.velocity;
    body.spin = given.spin;
    body.motion.centre = in_space<D>(cell * given.blocks[0].centre);
    for (std::size_t a = 0; a < 3; ++a) {
      body.motion.velocity.c[a] = given.velocity[a].at(0.0);
      body.motion.spin.c[a] = given.spin[a].at(0.0);
    }
    const Vector3& c = body.motion.centre;
    set_motion(*simulation, number, given.velocity, given.spin, {c[0], c[1], c[2]});
  }

  /// f(x) for the middles of lattice cells of an edge in a box that begins at `low`; none are told
  /// apart along the axis `left_out`, where x stays what `low` is.
  template <class F>
  static void for_each_in(const Vec<double, D>& low, const Vec<double, D>& size, double edge,
                          int left_out, F&& f) {
    Index<D> first{}, last{};
    for (std::size_t a = 0; a < D; ++a)
      if (static_cast<int>(a) != left_out)
        last[a] = static_cast<std::int32_t>(std::lround(size[static_cast<int>(a)] / edge)) - 1;
    for_each_index<D>(first, last, [&](const Index<D>& k) {
      Vec<double, D> x = low;
      for (int a = 0; a < D; ++a)
        if (a != left_out) x[a] += edge * (0.5 + k[static_cast<std::size_t>(a)]);
      f(x);
    });
  }

  /// What lies on the lower corner of the box is no surface: the body goes on behind.
  static bool goes_on(const TurnedBlock<D>& block, int axis, double side) {
    return side < 0.0 && std::abs(block.centre[axis] - 0.5 * block.size[axis]) < 1e-9;
  }

  /// e / 2 under the faces of blocks, nearly evenly, each carried by the nearest particle. At edges
  /// some push and others are felt.
  void add_points(int number, const BlocksGiven<D>& given, reference::SurfaceBody<D>& surface) {
    constexpr double spacing = (D == 2 ? 0.5 : 1.0) * e / cell;
    ContactPointsGiven told{{}, {}, {}, {}, {}, {}, e};
    std::vector<double> offsets, normals, areas, felt_areas;
    for (const TurnedBlock<D>& block : given.blocks)
      for (int axis = 0; axis < D; ++axis)
        for (const double side : {-0.5, 0.5}) {
          Vec<double, D> low = Vec<double, D>::zero() - 0.5 * block.size;
          low[axis] = side * (block.size[axis] - e / cell);
          if (goes_on(block, axis, side)) continue;
          for_each_in(low, block.size, spacing, axis, [&](Vec<double, D> at) {
            bool at_edge = false;
            for (int a = 0; a < D; ++a)
              at_edge = at_edge || (a != axis && !goes_on(block, a, at[a]) &&
                                    std::abs(at[a]) > 0.5 * block.size[a] - 0.75 * spacing);
            const double area = std::pow(spacing * cell, D - 1) * (1.0 + 0.05 * any());
            const auto add = [&](double pushes, double felt) {
              Vec<double, D> place = at;
              for (int a = 0; a < D; ++a) place[a] += 0.03 * spacing * any();
              const Vec<double, D> x = place_of(block, place), N = normal_of(block, axis, side);
              const std::size_t host = nearest(surface.body(), x);
              reference::ContactPoint<D> point = surface.point_at(x, N, 0.5 * e, pushes, host);
              point.A_felt = felt;
              point.face = 2 * axis + (side > 0.0 ? 1 : 0);
              const Vec<double, D> d = x + 0.5 * e * N - surface.body().particles[host].X;
              told.particles.push_back(static_cast<std::uint32_t>(host));
              offsets.insert(offsets.end(), d.c, d.c + D);
              normals.insert(normals.end(), N.c, N.c + D);
              areas.push_back(pushes);
              felt_areas.push_back(felt);
              told.faces.push_back(point.face);
              surface.points.push_back(point);
            };
            add(area, at_edge ? 0.0 : area);
            if (at_edge) add(0.0, area);
          });
        }
    told.held_by = given.held_by;
    told.offsets = offsets;
    told.normals = normals;
    told.areas = areas;
    told.felt_areas = felt_areas;
    add_surface(*simulation, number, told);
  }
  static std::size_t nearest(const reference::Body<D>& body, const Vec<double, D>& x) {
    std::size_t found = 0;
    for (std::size_t k = 0; k < body.particles.size(); ++k)
      if (body.particles[k].m > 0.0 &&
          norm(body.particles[k].X - x) < norm(body.particles[found].X - x))
        found = k;
    return found;
  }

  /// The nodes of both with the same velocities, those of the bodies and others besides.
  void start_nodes() {
    std::vector<std::map<Index<D>, Vec<double, D>>> v(surfaces.bodies.size());
    for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n, std::size_t body) {
      v[body].try_emplace(i, block.vector(n, velocity_at));
    });
    for (std::size_t b = 0; b < v.size(); ++b) {
      if (!surfaces.bodies[b].deforms()) continue;
      surfaces.bodies[b].kept->start([&](const Index<D>& i) { return v[b].at(i); });
    }
  }
  /// Both; what is set back knows the velocities before.
  void shake_nodes(double shaking) {
    for (reference::SurfaceBody<D>& body : surfaces.bodies) {
      if (!body.deforms()) continue;
      reference::Body<D>& of = body.kept->body;
      for (auto& [i, node] : of.nodes) {
        for (int a = 0; a < D; ++a) node.v[a] += shaking * any();
        reference::hold(step.walls_of(of), i, node.v);
      }
      step.reflect(of, &reference::Node<D>::v);
    }
    for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n, std::size_t body) {
      for (int a = 0; a < D; ++a)
        block.records[n][velocity_at + a] = surfaces.bodies[body].body().nodes.at(i).v[a];
    });
    for (KeptSpin& turning : simulation->domain.kept_spins) turning.begun = false;
  }

  /// By their places.
  void find_points() {
    const Surfaces<D>& fast = simulation->domain.surfaces;
    points.resize(surfaces.bodies.size());
    for (std::size_t b = 0; b < points.size(); ++b)
      for (const reference::ContactPoint<D>& c : surfaces.bodies[b].points)
        for (std::uint32_t k = 0; k < fast.points.size(); ++k)
          if (std::cmp_equal(part_of_point(fast, k).body, b) &&
              fast.points[k].area + fast.points[k].felt_area > 0.0 &&
              norm(fast.places[k] - c.x) < 1e-9 * cell)
            points[b].push_back(k);
  }
};

}  // namespace mpm::testing
