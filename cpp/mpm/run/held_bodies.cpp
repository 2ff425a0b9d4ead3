#include "mpm/run/held_bodies.hpp"

#include <algorithm>
#include <stdexcept>

#include "mpm/contact/candidates.hpp"
#include "mpm/contact/pair_cache.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/run/start_affine.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

constexpr const char* kept_velocity = "start_velocity";

/// List anew what is of which kind; rigid bodies keep their motions.
template <int D>
void list_kinds_again(Domain<D>& domain) {
  std::vector<RigidMotion> motions(domain.bodies.size());
  for (std::size_t k = 0; k < domain.rigid.size(); ++k)
    motions[domain.rigid_bodies[k]] = domain.rigid[k];
  domain.prescribed.clear();
  domain.rigid_bodies.clear();
  for (Body<D>& body : domain.bodies) body.rigid = -1;
  list_kinds(domain);
  for (std::size_t k = 0; k < domain.rigid.size(); ++k)
    domain.rigid[k] = motions[domain.rigid_bodies[k]];
}

/// Let contact know of which kind bodies are now.
template <int D>
void connect_again(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  connect_tiles(domain.contact, domain.grid, domain.bodies, domain.contact_settings.response);
  invalidate_pairs(domain.contact);
}

/// f(pool, row, component of the kept velocity) for the particles of a body.
template <int D, class F>
void for_each_kept(Domain<D>& domain, int body, F&& f) {
  ParticlePool<D>& pool = domain.pool_of(domain.body_at(body));
  const int kept = pool.columns.info(kept_velocity).first;
  for (const Patch<D>& patch : patches_of<D>(domain.grid.patches, body))
    for (const std::uint32_t row : pool.rows(patch)) f(pool, row, kept);
}

}  // namespace

template <int D>
void find_held_bodies(Simulation<D>& simulation) {
  if (!simulation.settings.run.settle) return;
  Domain<D>& domain = simulation.domain;
  std::vector<double> moves(domain.bodies.size(), 0.0);
  for (std::size_t b = 0; b < moves.size(); ++b)
    if (const Body<D>& body = domain.bodies[b]; body.given && !body.is_prescribed())
      moves[b] = std::ranges::any_of(body.given->velocities, [](double v) { return v != 0.0; });
  domain.grid.partition.comm->all_max(moves);
  for (std::size_t b = 0; b < moves.size(); ++b) {
    if (moves[b] == 0.0) continue;
    const Body<D>& body = domain.bodies[b];
    if (domain.grid.bonded)
      throw std::invalid_argument(
          body.name +
          " has a velocity at the start, and would be held while the run settles: bonded bodies "
          "move as one, so none of them can be held");
    simulation.held.push_back({static_cast<int>(b), body.kind});
    Columns& columns = domain.pool_of(body).columns;
    const auto is_kept = [](const ColumnInfo& info) { return info.name == kept_velocity; };
    if (std::ranges::none_of(columns.infos(), is_kept)) columns.add(kept_velocity, "m/s", D);
  }
}

template <int D>
void hold_bodies(Simulation<D>& simulation) {
  if (simulation.held.empty()) return;
  Domain<D>& domain = simulation.domain;
  for (const HeldBody& held : simulation.held) {
    for_each_kept(domain, held.body, [](ParticlePool<D>& pool, std::uint32_t row, int kept) {
      for (int a = 0; a < D; ++a) {
        pool.columns.component(kept + a)[row] = pool.v(a)[row];
        pool.v(a)[row] = Storage{0.0};
      }
      for (int k = 0; k < (pool.affine < 0 ? 0 : D * D); ++k)
        pool.affine_part(k)[row] = Storage{0.0};
    });
    Body<D>& body = domain.body_at(held.body);
    body.kind = BodyKind::prescribed;
    body.motion = std::make_unique<PrescribedMotion>();
    body.motion->start(Vector3::zero(), 0.0);
  }
  if (std::ranges::none_of(domain.bodies, &Body<D>::deforms))
    throw std::invalid_argument(
        "run.settle: all bodies that deform have a velocity at the start, and are held while the "
        "run settles, so none is left that could");
  list_kinds_again(domain);
  connect_again(domain);
}

template <int D>
void free_held_bodies(Simulation<D>& simulation) {
  if (simulation.held.empty()) return;
  for (const HeldBody& held : simulation.held) {
    Body<D>& body = simulation.domain.body_at(held.body);
    body.kind = held.kind;
    body.motion.reset();
  }
  simulation.held.clear();
  list_kinds_again(simulation.domain);
}

template <int D>
void start_moving(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  Ledger& ledger = domain.ledger;
  const double kinetic = kinetic_energy(domain);
  const std::array<double, 3> given = momentum(domain);
  const Vector3 turning = angular_totals(part_sums(domain)).all;
  for (const std::size_t b : domain.prescribed) {
    PrescribedMotion& motion = *domain.bodies[b].motion;
    motion.start(motion.now.centre, 0.0);
  }
  set_prescribed_velocities(domain);
  const Vector3 prescribed = angular_totals(part_sums(domain)).prescribed;
  const std::vector<HeldBody> held = simulation.held;
  if (!held.empty()) {
    free_held_bodies(simulation);
    connect_again(domain);
    std::vector<bool> meant(domain.bodies.size(), false);
    for (const HeldBody& each : held) {
      meant[static_cast<std::size_t>(each.body)] = true;
      for_each_kept(domain, each.body, [](ParticlePool<D>& pool, std::uint32_t row, int kept) {
        for (int a = 0; a < D; ++a)
          pool.v(a)[row] = static_cast<Storage>(pool.columns.component(kept + a)[row]);
      });
    }
    project_rigid_velocities(domain);
    // They are where they were, so that the lists of the last step are theirs.
    start_affine(domain, meant);
  }
  ledger.set_kinetic(kinetic_energy(domain), -kinetic_excess(domain.kept_spins));
  ledger.momentum = momentum(domain);
  ledger.motion_work += ledger.kinetic - kinetic;
  ledger.external += ledger.kinetic - kinetic;
  for (std::size_t a = 0; a < 3; ++a) ledger.motion_impulse[a] += ledger.momentum[a] - given[a];
  ledger.start_prescribed(domain.bodies, domain.grid.patches, domain.pools,
                          *domain.grid.partition.comm);
  // That of bodies with prescribed motion is counted by what they have now.
  const Vector3 all = angular_totals(part_sums(domain)).all;
  ledger.angular.prescribed_start -= all - turning - prescribed;
  probe_speeds(domain);
  // Steps and loads are judged by those of the run, not by those in which bodies stood still.
  simulation.watch.steps = {};
  simulation.watch.steps.start_from(ledger.made(), ledger.load_work);
}

template <int D>
void set_prescribed_velocities(Domain<D>& domain) {
  for (const std::size_t b : domain.prescribed) {
    PrescribedMotion& motion = *domain.bodies[b].motion;
    motion.radius = 0.0;
    for (const Patch<D>& patch : patches_of<D>(domain.grid.patches, static_cast<int>(b))) {
      ParticlePool<D>& pool = domain.pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch)) {
        const Vector3 x = in_space<D>(pool.position_of(row));
        motion.radius = std::max(motion.radius, norm(x - motion.now.centre));
        const Vector3 v = motion.now.velocity_at(x);
        for (int a = 0; a < D; ++a) pool.v(a)[row] = static_cast<Storage>(v[a]);
      }
    }
    motion.radius = all_max(*domain.grid.partition.comm, motion.radius);
  }
}

template void find_held_bodies<2>(Simulation<2>&);
template void find_held_bodies<3>(Simulation<3>&);
template void hold_bodies<2>(Simulation<2>&);
template void hold_bodies<3>(Simulation<3>&);
template void free_held_bodies<2>(Simulation<2>&);
template void free_held_bodies<3>(Simulation<3>&);
template void start_moving<2>(Simulation<2>&);
template void start_moving<3>(Simulation<3>&);
template void set_prescribed_velocities<2>(Domain<2>&);
template void set_prescribed_velocities<3>(Domain<3>&);

}  // namespace mpm
