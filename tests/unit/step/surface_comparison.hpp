#pragma once
// Steps of both of a SurfaceTwin, and what they come to held to each other.
#include "mpm/surfaces/restitution.hpp"
#include "step/surface_twin.hpp"

namespace mpm::testing {

template <int D>
class SurfaceComparison {
 public:
  SurfaceComparison(Report& report, SurfaceTwin<D>& twin) : report(report), twin_(twin) {
    for (std::size_t b = 0; b < twin.points.size(); ++b)
      CHECK_EQUAL(twin.points[b].size(), twin.surfaces.bodies[b].points.size());
    CHECK_EQUAL(twin.simulation->domain.surfaces.bonds.size(), twin.bonds.size());
    compare_set_back();
  }

  /// Another step, of another length than the last.
  void make_step(double time_step) {
    Domain<D>& domain = twin_.simulation->domain;
    reference::Step<D>& step = twin_.step;
    domain.step_before = step.dt_before = domain.step == 0 ? 0.0 : domain.time_step;
    domain.time_step = step.dt = time_step * (1.0 + 0.3 * static_cast<double>(domain.step % 2));
    domain.shift_before = domain.shift;
    domain.shift = shift_between(domain.step_before, domain.time_step);
    domain.time_after = domain.time + domain.time_step;
    for (const std::size_t b : domain.prescribed)
      domain.bodies[b].motion->begin_step(domain.time, domain.time_after);
    reference::begin_prescribed_motions(step);
    for (const Stage<D>& stage : twin_.simulation->stages) {
      stage.run(domain);
      after(stage.name);
    }
    step.t = domain.time = domain.time_after;
    ++domain.step;
  }

  Report& report;

 private:
  // Rounding: of bonds, which pull by small differences of places, 2e-11, of all else below 1e-11.
  static constexpr double tolerance = 3e-11, cell = SurfaceTwin<D>::cell;

  /// What differs most of vectors, and how large they are.
  struct Difference {
    double most = 0.0, largest = 0.0;
    template <int n>
    void add(const Vec<double, n>& x, const Vec<double, n>& expected) {
      const double apart = norm(x - expected);
      if (!(apart <= most)) most = apart;
      largest = std::max(largest, norm(expected));
    }
  };
  void check(const Difference& difference, double least = 0.0) {
    CHECK_CLOSE(difference.most, 0.0, rounding() * tolerance * std::max(difference.largest, least));
  }
  /// Where bodies hardly part, restitution takes (1 - e^2) m* u_n / dt: u_n is a small difference.
  double rounding() const {
    // Springs of particles are twice as stiff, and begin by small differences of velocities.
    if (!twin_.pressing.particles.empty()) return 4.0;
    return restitution_takes(twin_.simulation->domain.contact_settings) ? 20.0 : 1.0;
  }
  // [N], of a stress of a thousandth of E on a face of a cell: at the start there is none.
  static double least_force() { return 1e4 * std::pow(cell, D - 1); }

  void after(std::string_view stage) {
    if (stage == "exchange forces") {
      for (reference::SurfaceBody<D>& body : twin_.surfaces.bodies) {
        if (!body.deforms()) continue;
        body.kept->map_forces();
        body.give_to_nodes();
        body.kept->fold_forces();
      }
      compare_forces();
    }
    if (stage == "turn bodies on nodes of their own") {
      for (reference::SurfaceBody<D>& body : twin_.surfaces.bodies) body.push_as_one();
      for (reference::KeptNodes<D>& kept : twin_.kept) {
        kept.give_forces();
        kept.turn();
      }
      compare_forces();
    }
    if (stage == "advance nodes") {
      for (reference::KeptNodes<D>& kept : twin_.kept) kept.advance_nodes();
      compare_momenta();
    }
    if (stage == "touch surfaces") {
      for (reference::KeptNodes<D>& kept : twin_.kept) kept.update();
      for (reference::SurfaceBody<D>& body : twin_.surfaces.bodies) body.push_rigid(twin_.step);
      project_rigid_velocities(twin_.step);
      move_rigid_bodies(twin_.step);
      move_prescribed_bodies(twin_.step);
      twin_.surfaces.touch();
      twin_.read_pressing();
      twin_.pressing.press();
      reference::pull(twin_.surfaces, twin_.bonds);
      reference::restitute(twin_.surfaces);
      compare_particles();
      compare_surfaces();
    }
  }

  /// But for gravity, which stages add later; those of nodes beyond walls are with their images.
  void compare_forces() {
    Difference difference;
    twin_.for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n, std::size_t b) {
      if (twin_.step.walls.image(i)) return;
      const reference::Node<D>& node = twin_.surfaces.bodies[b].body().nodes.at(i);
      difference.add(block.vector(n, force_at), node.f - node.m * twin_.step.g);
    });
    check(difference, least_force());
  }
  /// m_i v_i: nodes of almost no mass have any velocity.
  void compare_momenta() {
    Difference difference;
    twin_.for_each_node([&](const Index<D>& i, NodeBlock<D>& block, int n, std::size_t b) {
      const reference::Node<D>& node = twin_.surfaces.bodies[b].body().nodes.at(i);
      difference.add(block.records[n][mass_at] * block.vector(n, velocity_at), node.m * node.v);
    });
    check(difference);
  }
  void compare_particles() {
    const Domain<D>& domain = twin_.simulation->domain;
    Difference places, deformation;
    for (const Patch<D>& patch : domain.grid.patches) {
      if (domain.body_of(patch).kind == BodyKind::deformable) continue;  // given to the reference
      const ParticlePool<D>& pool = domain.pool_of(patch);
      const reference::SurfaceBody<D>& body =
          twin_.surfaces.bodies[static_cast<std::size_t>(patch.body)];
      for (const std::uint32_t row : pool.rows(patch)) {
        places.add(pool.position_of(row), body.body().particles[pool.id[row]].x);
        for (int k = 0; patch.keeps && k < D * D; ++k)
          deformation.add(Vec<double, 1>{pool.deformation_part(k)[row]},
                          Vec<double, 1>{body.kept->F[pool.id[row]][k / D][k % D]});
      }
    }
    CHECK_CLOSE(places.most, 0.0, tolerance * cell);
    check(deformation);
  }

  /// f(number of the point in the simulation, its body, its number there).
  template <class F>
  void for_each_point(F&& f) {
    for (std::size_t b = 0; b < twin_.points.size(); ++b)
      for (std::size_t c = 0; c < twin_.points[b].size(); ++c) f(twin_.points[b][c], b, c);
  }
  void compare_set_back() {
    const Surfaces<D>& fast = twin_.simulation->domain.surfaces;
    CHECK_EQUAL(fast.set_back.size(), twin_.surfaces.set_back.size());
    for (const auto& [of, b] : twin_.surfaces.set_back) {
      const auto& [body, point, whom] = of;
      CHECK_CLOSE(set_back_of(fast, twin_.points[body][point], whom), b, tolerance * fast.spacing);
    }
  }

  void compare_surfaces() {
    const Surfaces<D>& fast = twin_.simulation->domain.surfaces;
    const reference::Surfaces<D>& expected = twin_.surfaces;
    Difference places;
    for_each_point([&](std::uint32_t k, std::size_t b, std::size_t c) {
      places.add(fast.places[k], expected.bodies[b].points[c].x);
    });
    CHECK_CLOSE(places.most, 0.0, tolerance * fast.spacing);
    CHECK_EQUAL(fast.touching, expected.touches.size() + twin_.pressing.touching);
    double push = 0.0, rub = 0.0;
    for (const reference::PressingParticle<D>& p : twin_.pressing.particles) {
      push += p.stored_push;
      rub += p.stored_rub;
    }
    for (const reference::SurfaceBody<D>& body : expected.bodies) {
      push += body.stored_push;
      rub += body.stored_rub;
    }
    // Where springs just begin, what is stored is as sure as the overlaps, to the third power.
    const double least = 1e-2 * least_force() * fast.spacing;
    CHECK_CLOSE(fast.stored_push, push, tolerance * std::max(push, least));
    CHECK_CLOSE(fast.stored_rub, rub, tolerance * std::max(push, least));
    compare_touches();
    compare_pressing();
    compare_wholes();
    compare_faces();
  }
  /// Each by itself: forces on the point, and what is remembered.
  void compare_touches() {
    const Surfaces<D>& fast = twin_.simulation->domain.surfaces;
    Difference pushes, rubs, slips, onsets;
    for (const reference::SurfaceTouch<D>& touch : twin_.surfaces.touches) {
      const std::uint32_t k = twin_.points[touch.body][touch.point];
      const SurfacePart<D>& part = part_of_point(fast, k);
      const auto found = std::ranges::find_if(part.touches, [&](const SurfaceTouch<D>& one) {
        return one.point == k && one.opposite == touch.whom;
      });
      const bool is_there = found != part.touches.end();
      CHECK(is_there);
      if (!is_there) continue;
      pushes.add(found->push, touch.push);
      rubs.add(found->rub, touch.rub);
      const KeptOfContact<MemoryOfTouch<D>> wanted{k, touch.whom, {}};
      const auto kept = std::ranges::lower_bound(part.kept, wanted, std::less<>{});
      const auto of = twin_.surfaces.kept.find({touch.body, touch.point, touch.whom});
      const bool is_kept = kept != part.kept.end() && !(wanted < *kept);
      CHECK(is_kept);
      if (!is_kept) continue;
      slips.add(kept->value.slip, of->second.s);
      onsets.add(Vec<double, 1>{kept->value.onset}, Vec<double, 1>{of->second.w});
    }
    check(pushes, least_force());
    check(rubs, least_force());
    check(slips, 0.01 * fast.spacing);
    check(onsets, 0.01 * fast.spacing);
    compare_levelled();
  }
  /// What particles in space are pushed with, and what they remember.
  void compare_pressing() {
    const Domain<D>& domain = twin_.simulation->domain;
    Difference pushes, rubs, slips, lengths;
    for (const Patch<D>& patch : domain.grid.patches) {
      const ParticlePool<D>& pool = domain.pool_of(patch);
      const PressingColumns& at = pool.pressing;
      if (at.force < 0) continue;
      for (const std::uint32_t row : pool.rows(patch)) {
        const reference::PressingParticle<D>& p = twin_.pressing.particles[pool.id[row]];
        const auto number = [&](int column) { return pool.columns.component(column)[row]; };
        Vec<double, D> push, slip;
        for (int a = 0; a < D; ++a) {
          push[a] = number(at.force + a);
          slip[a] = number(at.slip + a);
        }
        CHECK_EQUAL(static_cast<int>(number(at.opposite)) - 1, p.whom);
        pushes.add(push, p.push);
        rubs.add((-0.8 * number(at.stiffness)) * slip, p.rub);
        slips.add(slip, p.memory.s);
        lengths.add(Vec<double, 2>{number(at.onset), number(at.set_back)},
                    Vec<double, 2>{p.memory.w, p.set_back});
      }
    }
    const double spacing = domain.surfaces.spacing;
    check(pushes, least_force());
    check(rubs, least_force());
    check(slips, 0.01 * spacing);
    check(lengths, 0.01 * spacing);
  }
  void compare_levelled() {
    const Surfaces<D>& fast = twin_.simulation->domain.surfaces;
    std::size_t count = 0;
    for (const SurfacePart<D>& part : fast.parts) count += part.levelled.size();
    std::size_t left = 0;
    for (const auto& [of, expected] : twin_.surfaces.levelled) {
      const auto& [body, point, whom] = of;
      const std::uint32_t k = twin_.points[body][point];
      const auto* found = find_kept(part_of_point(fast, k).levelled, k, whom);
      CHECK(found != nullptr);
      if (found) CHECK_CLOSE(found->by, expected.by, tolerance * fast.spacing);
      ++left;
    }
    CHECK_EQUAL(count, left);
  }
  void compare_wholes() {
    const Surfaces<D>& fast = twin_.simulation->domain.surfaces;
    Difference forces, moments;
    for (std::size_t b = 0; b < twin_.surfaces.bodies.size(); ++b) {
      const auto at =
          std::ranges::lower_bound(fast.on_bodies, static_cast<int>(b), {}, &ActingOnBody::body);
      const bool acts = at != fast.on_bodies.end() && std::cmp_equal(at->body, b);
      const Wrench all = acts ? at->all() : Wrench{};
      forces.add(all.force, twin_.surfaces.bodies[b].force);
      moments.add(all.moment, twin_.surfaces.bodies[b].moment);
    }
    check(forces, least_force());
    check(moments, cell * least_force());
  }

  /// What acts on bodies and not between them is what faces of the box give.
  void compare_faces() {
    Vector3 force = Vector3::zero(), moment = force, by_walls = force, moment_by_walls = force;
    double size = rounding() * least_force();
    for (const reference::SurfaceBody<D>& body : twin_.surfaces.bodies) {
      force += body.force;
      moment += body.moment;
      for (const auto& [i, t] : body.f) {
        force += in_space<D>(t);
        moment += cross(in_space<D>(body.place(i)), in_space<D>(t));
        size = std::max(size, rounding() * norm(t));
      }
    }
    for (const reference::PressingParticle<D>& p : twin_.pressing.particles) {
      force += in_space<D>(p.push) + in_space<D>(p.rub);
      moment += cross(in_space<D>(p.x), in_space<D>(p.push)) +
                cross(in_space<D>(p.place), in_space<D>(p.rub));
    }
    for (const SurfacePart<D>& part : twin_.simulation->domain.surfaces.parts) {
      for (int a = 0; a < D; ++a)
        for (const auto& axis : part.by_walls.of) by_walls[a] += axis[0][a] + axis[1][a];
      moment_by_walls += part.moment_by_walls;
    }
    CHECK_CLOSE(norm(by_walls - force), 0.0, tolerance * size);
    CHECK_CLOSE(norm(moment_by_walls - moment), 0.0, 10.0 * cell * tolerance * size);
  }

  SurfaceTwin<D>& twin_;
};

}  // namespace mpm::testing
