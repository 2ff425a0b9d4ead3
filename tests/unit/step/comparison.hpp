#pragma once
// What the stages have written, held to what the reference step has.
#include <functional>
#include <map>

#include "check.hpp"
#include "step/twin.hpp"

namespace mpm::testing {

template <int D>
class Comparison {
 public:
  Comparison(Report& report, Twin<D>& twin) : report(report), twin_(twin) {
    for (const reference::Body<D>& body : twin.reference.bodies)
      for (const reference::Particle<D>& p : body.particles)
        if (body.prescribed()) {
          prescribed_at_start_ += 0.5 * p.m * dot(p.v, p.v);
          motion_at_start_ += p.m * p.v;
        }
  }

  /// Make a stage of the reference; compare what it has written. False for a stage that has none.
  /// What is left for later is compared after a later stage of the same step.
  bool after(std::string_view stage, Scheme scheme) {
    auto& step = twin_.reference;
    using Node = reference::Node<D>;
    const auto v = scheme == Scheme::musl ? &Node::v_new : &Node::v;  // that strains the material
    const bool meet = twin_.domain.has_contact();
    const auto later = [&](unsigned data) { return [this, data] { pending_ |= data; }; };
    const auto map_forces = [&] { step.map_forces(), load_surfaces(step), add_body_forces(step); };
    const bool at_end = scheme == Scheme::usf;
    const auto update_stress = [&] { carry_loads(step, v, at_end), step.update_stress(v, at_end); };
    const std::map<std::string_view, std::function<void()>> stages = {
        {"activate tiles", [&] { lists(); }},
        {"filter velocities", [&] { filter(); }},
        {"map momentum", later(momentum)},
        {"map momentum and forces", later(momentum | forces)},
        {"fold momentum", later(momentum)},
        {"exchange momentum", later(momentum)},
        {"exchange momentum and forces", [&] { forced_ = true, pending_ |= momentum | forces; }},
        {"find velocities", [&] { step.map_momentum(), map_forces(); }},
        {"contact momentum",
         [&] {
           if (meet) find_contacts(step), contact_momentum(step, &Node::v);
         }},
        {"average pressure", [] {}},
        // Of matter that flows, which is none here (tests/recipes/test_matter_that_flows.py).
        {"map volumes", [] {}},
        {"heat gases", [] {}},
        {"map forces", later(forces)},
        {"load surfaces", later(forces)},
        {"body forces", later(forces)},
        {"place dashpots", later(dashpots)},
        {"fold forces", later(forces)},
        {"exchange forces", [&] { map_forces(), forced_ = true; }},
        {"place springs of walls", later(springs)},
        {"touch walls", [&] { touch_walls(step), pending_ &= ~springs; }},
        {"absorb at walls", [&] { absorb_at_walls(step), pending_ &= ~dashpots; }},
        {"contact forces",
         [&] {
           if (meet) contact_forces(step);
         }},
        {"advance nodes", [&] { step.advance_nodes(), forced_ = false, add_works(); }},
        {"release from contact", [] {}},
        {"restore contact", [] {}},
        {"advance particles", [&] { step.advance_particles(); }},
        {"advance and move particles", [&] { step.advance_particles(), step.move_particles(); }},
        {"advance and remap particles", [&] { step.advance_particles(), pending_ |= remapped; }},
        {"project rigid velocities", [&] { project_rigid_velocities(step); }},
        {"remap momentum", later(remapped)},
        {"remap rigid bodies", later(remapped)},
        {"fold remapped", later(remapped)},
        {"exchange remapped", later(remapped)},
        {"find remapped velocities", [&] { step.remap_momentum(); }},
        {"contact remapped",
         [&] {
           if (meet) contact_momentum(step, &Node::v_new);
         }},
        {"update stress", update_stress},
        {"update stress, move particles", [&] { update_stress(), step.move_particles(); }},
        {"move particles", [&] { step.move_particles(); }},
        {"move rigid bodies", [&] { move_rigid_bodies(step), move_prescribed_bodies(step); }},
        {"record contacts", [&] { records(); }},
        {"sum energies", [&] { energies(); }},
    };
    const auto known = stages.find(stage);
    if (known == stages.end()) return false;
    known->second();
    nodes(stage);
    particles(stage);
    pieces();
    return true;
  }

 private:
  /// What stages may leave for later.
  enum Data : unsigned { momentum = 1, forces = 2, dashpots = 4, remapped = 8, springs = 16 };

  void nodes(std::string_view stage) {
    const bool mapped = stage == "find velocities" || stage == "contact momentum" ||
                        stage == "exchange forces" || stage == "absorb at walls" ||
                        stage == "contact forces" || stage == "touch walls";
    const bool mapped_anew = stage == "find remapped velocities" || stage == "contact remapped";
    const bool advanced = stage == "advance nodes";
    if (!mapped && !mapped_anew && !advanced) return;
    if (mapped) pending_ &= ~(momentum | (forced_ ? forces : 0u));
    if (mapped_anew) pending_ &= ~remapped;
    const Domain<D>& domain = twin_.domain;
    for_each_node([&](const Patch<D>& patch, const NodeBlock<D>& block, int n, const Index<D>& i,
                      const reference::Body<D>& body) {
      // Nobody asks for the nodes of prescribed bodies where no others are, and none beyond walls.
      const bool beyond = domain.grid.walls.image(i).has_value();
      if (body.prescribed() && (beyond || !patch.in_contact)) return;
      const auto at = body.nodes.find(i);
      const reference::Node<D> node = at == body.nodes.end() ? reference::Node<D>{} : at->second;
      if (body.prescribed() && at == body.nodes.end()) return;
      const Vec<double, D> gravity = body.prescribed() ? Vec<double, D>::zero() : domain.gravity;
      const unsigned constrained = domain.grid.walls.constrained_axes(i);
      if (mapped) CHECK_CLOSE(block.mass()[n], node.m, 1e-12 * mass_scale);
      for (int a = 0; a < D; ++a) {
        if (mapped || advanced)
          CHECK_CLOSE(block.velocity(a)[n], node.v[a], tolerance(node, 100.0));
        if (mapped && forced_ && !beyond && !(constrained >> a & 1u))
          CHECK_CLOSE(block.force(a)[n] + node.m * gravity[a], node.f[a], 1e-11 * force_scale);
        if (advanced) CHECK_CLOSE(block.increment(a)[n], node.dv[a], tolerance(node, 100.0));
        if (mapped_anew) CHECK_CLOSE(block.remapped(a)[n], node.v_new[a], tolerance(node, 100.0));
      }
    });
  }
  /// f(patch, block, node, its coordinates, the body of the reference).
  template <class F>
  void for_each_node(F&& f) {
    TileGrid<D>& grid = twin_.domain.grid;
    for (std::size_t p = 0; p < grid.patches.size(); ++p) {
      const Patch<D>& patch = grid.patches[p];
      const NodeBlock<D> block = grid.block(p);
      for (int n = 0; n < block.count; ++n) {
        Index<D> i = patch.shape.index(n);
        for (std::size_t a = 0; a < D; ++a) i[a] += grid.first_cell(patch.tile)[a];
        f(patch, block, n, i, twin_.reference.bodies[static_cast<std::size_t>(patch.body)]);
      }
    }
  }
  /// In each step whose number `filter_every` divides, counted from 1.
  void filter() {
    const Domain<D>& domain = twin_.domain;
    const bool now = (++steps_) % domain.filter_every == 0;
    filter_velocities(twin_.reference, now ? domain.filter_order : 0);
    for (reference::Body<D>& body : twin_.reference.bodies)
      for (reference::Particle<D>& p : body.particles)
        if (!now || !body.deforms()) p.unseen = Vec<double, D>::zero();
    if (!now) return;
    const ParticlePool<D>& pool = domain.pools[0];
    for (const Patch<D>& patch : domain.grid.patches)
      for (const std::uint32_t k : pool.rows(patch)) {
        const auto& body = twin_.reference.bodies[static_cast<std::size_t>(patch.body)];
        for (int a = 0; a < D; ++a)
          CHECK_CLOSE(pool.unseen_velocity(a)[k], body.particles[pool.id[k]].unseen[a], 1e-10);
      }
  }
  /// Every particle is in the list of the cell in which the reference has it.
  void lists() {
    const TileGrid<D>& grid = twin_.domain.grid;
    const ParticlePool<D>& pool = twin_.domain.pools[0];
    std::size_t count = 0;
    for (const Patch<D>& patch : grid.patches)
      for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
        for (std::uint32_t k = 0; k < cell.count; ++k, ++count) {
          const auto& body = twin_.reference.bodies[static_cast<std::size_t>(patch.body)];
          const reference::Particle<D>& p = body.particles[pool.id[cell.rows[k]]];
          CHECK(grid.cell_of(p.x) == cell.cell, patch.body, cell.rows[k]);
        }
      });
    CHECK_EQUAL(count, pool.count());
  }
  void pieces() {
    const auto& found = twin_.domain.pools[0].pieces;
    std::size_t k = 0;
    for (const reference::Load<D>& load : twin_.reference.loads)
      for (const reference::Piece<D>& piece : load.pieces) {
        for (int a = 0; a < D; ++a) {
          CHECK_CLOSE(found[k].area[a], piece.a[a], 1e-13);
          CHECK_CLOSE(found[k].arm[a], piece.middle[a], 1e-13);
        }
        CHECK_CLOSE(found[k].size, piece.size, 1e-13);
        ++k;
      }
    CHECK_EQUAL(k, found.size());
  }
  void particles(std::string_view stage) {
    for (std::size_t b = 0; b < twin_.domain.bodies.size(); ++b) {
      const ParticlePool<D>& pool = twin_.domain.pools[0];
      for_each_row(twin_.domain.grid.patches, pool, static_cast<int>(b), 0, [&](std::uint32_t k) {
        const reference::Particle<D>& p = twin_.reference.bodies[b].particles[pool.id[k]];
        for (int a = 0; a < D; ++a) {
          if (stage.find("move") != stage.npos) CHECK_CLOSE(pool.x(a)[k], p.x[a], 1e-12);
          CHECK_CLOSE(pool.v(a)[k], p.v[a], 1e-10);
        }
        for (int c = 0; c < (pool.affine < 0 ? 0 : D * D); ++c)
          CHECK_CLOSE(pool.affine_part(c)[k], p.C[c / D][c % D], 1e-9);
        CHECK_CLOSE(pool.volume()[k], p.V, 1e-12 * p.V);
        for (int c = 0; c < (pool.at.damping_stress < 0 ? 0 : Sym<double, D>::size); ++c)
          CHECK_CLOSE(pool.columns.component(pool.at.damping_stress + c)[k], p.s.c[c], 1e-11 * 1e8);
        for (int c = 0; c < Sym<double, D>::size; ++c)
          CHECK_CLOSE(pool.stress(c)[k], p.sigma.c[c], 1e-11 * 1e8);
      });
    }
  }
  /// The force on the first body, of all nodes.
  void records() {
    if (!twin_.domain.has_contact()) return;
    Vec<double, D> force = Vec<double, D>::zero();
    for (const auto& contact : twin_.reference.contacts) force -= contact.f;
    const auto& pairs = twin_.domain.contact.records.all();
    CHECK_EQUAL(pairs.size(), std::size_t{1});
    for (int a = 0; a < D; ++a) CHECK_CLOSE(pairs[0].force[a], force[a], 1e-10 * force_scale);
  }
  void add_works() {
    const reference::Works works = reference::works(twin_.reference);
    external_ += works.gravity + works.loads;
    load_work_ += works.loads;
    absorbed_ += works.absorbed;
    damped_ += works.damped;
    touched_ += works.touched;
    CHECK(works.damped >= 0.0);
    motion_work_ -= works.on_prescribed;
    for (const reference::Body<D>& body : twin_.reference.bodies)
      for (const auto& [i, node] : body.nodes)
        if (body.prescribed()) pushed_ += twin_.domain.time_step * node.f;
  }
  /// The last stage of all: nothing is left to be compared.
  void energies() {
    CHECK_EQUAL(pending_, 0u);
    double kinetic = 0.0, prescribed = 0.0;
    Vec<double, D> momentum = Vec<double, D>::zero(), motion = Vec<double, D>::zero();
    for (const auto& body : twin_.reference.bodies)
      for (const auto& p : body.particles) {
        kinetic += 0.5 * p.m * dot(p.v, p.v);
        for (int c = 0; c < D * D; ++c)
          kinetic += 0.5 * p.m * twin_.reference.moment * p.C[c / D][c % D] * p.C[c / D][c % D];
        momentum += p.m * p.v;
        if (!body.prescribed()) continue;
        prescribed += 0.5 * p.m * dot(p.v, p.v);
        motion += p.m * p.v;
      }
    const Ledger& ledger = twin_.domain.ledger;
    CHECK_CLOSE(ledger.kinetic, kinetic, 1e-11 * kinetic);
    const double work = motion_work_ + prescribed - prescribed_at_start_;
    CHECK_CLOSE(ledger.load_work, load_work_, 1e-11 * kinetic);
    CHECK_CLOSE(ledger.motion_work, work, 1e-11 * kinetic);
    CHECK_CLOSE(ledger.external, external_ + work, 1e-11 * kinetic);
    CHECK_CLOSE(ledger.absorbed, absorbed_, 1e-11 * kinetic);
    if (!twin_.domain.has_contact())
      CHECK_CLOSE(ledger.friction + ledger.contact + ledger.springs, touched_, 1e-11 * kinetic);
    if (twin_.domain.grid.has_wall_springs) CHECK(ledger.friction > 0.0 && touched_ != 0.0);
    CHECK_CLOSE(ledger.damped - ledger.damped_stiffness, damped_, 1e-11 * kinetic);
    CHECK_CLOSE(ledger.residual(), 0.0, 1e-11 * kinetic);
    for (std::size_t a = 0; a < D; ++a) {
      const int axis = static_cast<int>(a);
      CHECK_CLOSE(ledger.momentum[a], momentum[axis], 1e-12 * kinetic);
      CHECK_CLOSE(ledger.motion_impulse[a], motion[axis] - motion_at_start_[axis] - pushed_[axis],
                  1e-12 * kinetic);
    }
    for (std::size_t l = 0; l < twin_.domain.loads.size(); ++l) {
      impulse_[l] += twin_.domain.time_step * twin_.reference.loads[l].force;
      for (int a = 0; a < D; ++a) {
        CHECK_CLOSE(twin_.domain.loads[l].force[a], twin_.reference.loads[l].force[a],
                    1e-11 * force_scale);
        CHECK_CLOSE(twin_.domain.loads[l].impulse[a], impulse_[l][a],
                    1e-11 * force_scale * twin_.domain.time_step);
      }
    }
  }
  /// Of a velocity: a node that particles hardly reach divides rounding by its small mass.
  static double tolerance(const reference::Node<D>& node, double size) {
    return 1e-11 * size * (1.0 + mass_scale / std::max(node.m, 1e-300) * 1e-3);
  }
  // Density times volume of a cell and more; stress over a cell's face and more. Sums of some dozen
  // such numbers, taken in another order, differ by their roundings, 1e-14; mutations of 1e-7 show.
  static constexpr double mass_scale = 1000.0, force_scale = 1e9;

  Report& report;
  Twin<D>& twin_;
  std::int64_t steps_ = 0;  // with a filter or not
  unsigned pending_ = 0;    // data that has been written and not yet compared
  bool forced_ = false;     // the nodes have all forces, and not yet increments
  // Of all steps so far.
  double external_ = 0.0, load_work_ = 0.0, absorbed_ = 0.0, damped_ = 0.0, touched_ = 0.0,
         motion_work_ = 0.0;
  Vec<double, D> pushed_ = Vec<double, D>::zero();
  Vec<double, D> impulse_[2] = {Vec<double, D>::zero(), Vec<double, D>::zero()};
  double prescribed_at_start_ = 0.0;
  Vec<double, D> motion_at_start_ = Vec<double, D>::zero();
};

}  // namespace mpm::testing
