// Every stage does what the reference step does, to rounding: nodes and particles are compared
// after each.
#include "check.hpp"
#include "step/twin.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

template <int D>
class Comparison {
 public:
  Comparison(Report& report, Twin<D>& twin) : report(report), twin_(twin) {}

  /// Make a stage of the reference; compare what it has written. False for a stage that has none.
  bool after(std::string_view stage, Scheme scheme) {
    auto& step = twin_.reference;
    using Node = reference::Node<D>;
    const auto v = scheme == Scheme::musl ? &Node::v_new : &Node::v;  // that strains the material
    const bool meet = twin_.domain.has_contact();
    const auto nothing = [] {};
    const std::map<std::string_view, std::function<void()>> stages = {
        {"activate tiles", nothing},
        {"map momentum", nothing},
        {"map momentum and forces", nothing},
        {"fold momentum", nothing},
        {"exchange momentum", nothing},
        {"exchange momentum and forces", [&] { forced_ = true; }},
        {"find velocities", [&] { step.map_momentum(), step.map_forces(); }},
        {"contact momentum",
         [&] {
           if (meet) step.find_contacts(), step.contact_momentum(&Node::v);
         }},
        {"map forces", nothing},
        {"load surfaces", nothing},
        {"place dashpots", nothing},
        {"fold forces", nothing},
        {"exchange forces", [&] { step.map_forces(), forced_ = true; }},
        {"absorb at walls", [&] { step.absorb_at_walls(); }},
        {"contact forces",
         [&] {
           if (meet) step.contact_forces();
         }},
        {"advance nodes", [&] { step.advance_nodes(), forced_ = false; }},
        {"advance particles", [&] { step.advance_particles(); }},
        {"advance and move particles", [&] { step.advance_particles(), step.move_particles(); }},
        {"advance and remap particles", [&] { step.advance_particles(); }},
        {"project rigid velocities", [&] { step.project_rigid_velocities(); }},
        {"remap momentum", nothing},
        {"remap rigid bodies", nothing},
        {"fold remapped", nothing},
        {"exchange remapped", nothing},
        {"find remapped velocities", [&] { step.remap_momentum(); }},
        {"contact remapped",
         [&] {
           if (meet) step.contact_momentum(&Node::v_new);
         }},
        {"update stress", [&] { step.update_stress(v); }},
        {"update stress, move particles", [&] { step.update_stress(v), step.move_particles(); }},
        {"move particles", [&] { step.move_particles(); }},
        {"move rigid bodies", [&] { step.move_rigid_bodies(); }},
        {"record contacts", [&] { records(); }},
        {"sum energies", [&] { energies(); }},
    };
    const auto known = stages.find(stage);
    if (known == stages.end()) return false;
    known->second();
    nodes(stage);
    particles(stage);
    return true;
  }

 private:
  void nodes(std::string_view stage) {
    const Domain<D>& domain = twin_.domain;
    const bool mapped = stage == "find velocities" || stage == "contact momentum" ||
                        stage == "exchange forces" || stage == "absorb at walls" ||
                        stage == "contact forces";
    const bool forced = forced_ && mapped;
    const bool remapped = stage == "find remapped velocities" || stage == "contact remapped";
    for (std::size_t p = 0; p < domain.grid.patches.size(); ++p) {
      const Patch<D>& patch = domain.grid.patches[p];
      const NodeBlock<D> block = twin_.domain.grid.block(p);
      const auto& known = twin_.reference.bodies[static_cast<std::size_t>(patch.body)].nodes;
      for (int n = 0; n < block.count; ++n) {
        Index<D> i = patch.shape.index(n);
        for (std::size_t a = 0; a < D; ++a) i[a] += domain.grid.first_cell(patch.tile)[a];
        const auto at = known.find(i);
        const reference::Node<D> node = at == known.end() ? reference::Node<D>{} : at->second;
        const bool beyond = domain.grid.walls.image(i).has_value();
        const unsigned constrained = domain.grid.walls.constrained_axes(i);
        if (mapped) CHECK_CLOSE(block.mass()[n], node.m, 1e-12 * mass_scale);
        for (int a = 0; a < D; ++a) {
          if (mapped || stage == "advance nodes")
            CHECK_CLOSE(block.velocity(a)[n], node.v[a], tolerance(node, 100.0));
          if (forced && !beyond && !(constrained >> a & 1u))
            CHECK_CLOSE(block.force(a)[n] + node.m * domain.gravity[a], node.f[a],
                        1e-11 * force_scale);
          if (stage == "advance nodes")
            CHECK_CLOSE(block.force(a)[n], node.dv[a], tolerance(node, 100.0));
          if (remapped) CHECK_CLOSE(block.force(a)[n], node.v_new[a], tolerance(node, 100.0));
        }
      }
    }
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
        CHECK_CLOSE(pool.volume()[k], p.V, 1e-12 * p.V);
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
  void energies() {
    double kinetic = 0.0;
    Vec<double, D> momentum = Vec<double, D>::zero();
    for (const auto& body : twin_.reference.bodies)
      for (const auto& p : body.particles) {
        kinetic += 0.5 * p.m * dot(p.v, p.v);
        momentum += p.m * p.v;
      }
    const Ledger& ledger = twin_.domain.ledger;
    CHECK_CLOSE(ledger.kinetic, kinetic, 1e-11 * kinetic);
    for (std::size_t a = 0; a < D; ++a)
      CHECK_CLOSE(ledger.momentum[a], momentum[static_cast<int>(a)], 1e-12 * kinetic);
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
  bool forced_ = false;  // the nodes have all forces, and not yet increments
};

template <int D>
void check_step(Report& report, const Choice<D>& choice, Scheme scheme,
                std::span<const Stage<D>> stages) {
  Twin<D> twin(choice);
  Comparison<D> comparison(report, twin);
  for (int step = 0; step < 3; ++step)
    for (const Stage<D>& stage : stages) {
      stage.run(twin.domain);
      CHECK(comparison.after(stage.name, scheme), stage.name);
    }
}

/// As the scheme lists the stages, and fused.
template <int D>
void check_schemes(Report& report, const Choice<D>& choice) {
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl}) {
    check_step(report, choice, scheme, stages_of<D>(scheme, false));
    check_step(report, choice, scheme, stages_of<D>(scheme, true));
  }
}

template <int D>
void check_all(Report& report) {
  Bases::for_each([&](BasisId basis, const auto&) {
    Choice<D> choice;
    choice.basis = basis;
    check_schemes(report, choice);
    choice.pic_damping = 1e3;
    choice.rigid = true;
    check_schemes(report, choice);
    choice.rigid = false;
    choice.contact = true;
    choice.walls.fill(Wall::slip);
    choice.walls[0] = Wall::fixed;
    choice.walls[1] = Wall::absorbing;
    choice.walls[3] = Wall::free;
    check_schemes(report, choice);
  });
}

}  // namespace

void test_stages(Report& report) {
  check_all<2>(report);
  check_all<3>(report);
}
