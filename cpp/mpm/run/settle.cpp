#include "mpm/run/settle.hpp"

#include <algorithm>
#include <cmath>

#include "mpm/contact/set_back.hpp"
#include "mpm/run/held_bodies.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// Bring all to rest; the ledger counts it as damping.
template <int D>
void stop_all(Domain<D>& domain) {
  const double before = kinetic_energy(domain);
  const Vector3 turned = angular_totals(part_sums(domain)).all;
  for (const Patch<D>& patch : domain.grid.patches) {
    ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch)) {
      for (int a = 0; a < D; ++a) pool.v(a)[row] = Storage{0.0};
      for (int c = 0; c < (pool.affine < 0 ? 0 : D * D); ++c)
        pool.affine_part(c)[row] = Storage{0.0};
    }
  }
  project_rigid_velocities(domain);
  stop_kept_nodes(domain);
  Ledger& ledger = domain.ledger;
  ledger.set_kinetic(kinetic_energy(domain), -kinetic_excess(domain.kept_spins));
  ledger.damped += before - ledger.kinetic;
  ledger.momentum = momentum(domain);
  ledger.angular.impulses.damping += angular_totals(part_sums(domain)).all - turned;
}

/// How much of the way into each other bodies that are pressed have gone at a time before 0: all
/// after a half of the longest time of settling.
double share_pressed(const SettleSettings& settle, double time) {
  return std::clamp(2.0 * (time + settle.longest) / settle.longest, 0.0, 1.0);
}

template <int D>
bool has_pressed(const Simulation<D>& simulation) {
  return std::ranges::any_of(simulation.settings.contact.pair_laws,
                             [](const auto& x) { return x.second.pressed > 0.0; });
}

/// Let them go on to where they are at the start of a step.
template <int D>
void press_further(Simulation<D>& simulation, double share) {
  double before = share;
  for (const auto& [key, law] : simulation.settings.contact.pair_laws) {
    if (!(law.pressed > 0.0)) continue;
    for (auto& [of, now] : simulation.domain.contact_settings.pair_laws)
      if (of == key) {
        before = now.pressed / law.pressed;
        now.pressed = share * law.pressed;
      }
  }
  simulation.pressed_further = std::max(share - before, 0.0);
}

/// What that took comes from outside; contact has counted it as made.
template <int D>
void count_pressing(Simulation<D>& simulation) {
  if (!(simulation.pressed_further > 0.0)) return;
  Domain<D>& domain = simulation.domain;
  const double work = work_of_pressing(domain.contact, domain.bodies, simulation.settings.contact,
                                       simulation.pressed_further, domain.grid.cell_size,
                                       *domain.grid.partition.comm);
  simulation.pressed_further = 0.0;
  domain.ledger.external += work;
  domain.ledger.contact += work;
  domain.ledger.largest = std::max(domain.ledger.largest, std::abs(domain.ledger.external));
}

}  // namespace

template <int D>
void start_settling(Simulation<D>& simulation) {
  if (!simulation.settings.run.settle) return;
  Domain<D>& domain = simulation.domain;
  domain.time = -simulation.settings.run.settle->longest;
  for (Body<D>& body : domain.bodies)
    if (body.is_prescribed()) body.motion->stand_still();
  // Those that have none get one, which is nothing once the run has begun.
  const auto none = static_cast<int>(domain.dampings.size());
  domain.dampings.emplace_back();
  for (Body<D>& body : domain.bodies)
    if (body.deforms() && body.damping < 0) body.damping = none;
}

template <int D>
void begin_settling_step(Simulation<D>& simulation) {
  const auto& settle = simulation.settings.run.settle;
  if (!settle) return;
  Domain<D>& domain = simulation.domain;
  for (Damping& damping : domain.dampings) damping.now = {0.0, settle->local};
  for (const std::size_t b : domain.prescribed) domain.bodies[b].motion->stand_still();
  if (has_pressed(simulation)) press_further(simulation, share_pressed(*settle, domain.time));
}

template <int D>
void end_settling_step(Simulation<D>& simulation) {
  const auto& settle = simulation.settings.run.settle;
  if (!settle) return;
  Domain<D>& domain = simulation.domain;
  count_pressing(simulation);
  const double ratio = domain.ledger.unbalanced;
  const bool balanced = ratio <= settle->ratio;
  const bool pressing = has_pressed(simulation) && share_pressed(*settle, domain.time) < 1.0;
  if ((!balanced || pressing) && domain.settles()) return;
  // Rest is part of it: forces balance in the middle of a swing too, and what moves there is then
  // at rest where it is in balance.
  stop_all(domain);
  domain.time = domain.time_after = 0.0;
  start_moving(simulation);
  if (balanced) return;
  Note note{.kind = NoteKind::unsettled, .body = 0, .value = ratio, .against = settle->ratio};
  note.group = domain.bodies[0].group;
  note.step = domain.step;
  note.count = 1;
  simulation.watch.notes.push_back(note);
}

template void start_settling<2>(Simulation<2>&);
template void start_settling<3>(Simulation<3>&);
template void begin_settling_step<2>(Simulation<2>&);
template void begin_settling_step<3>(Simulation<3>&);
template void end_settling_step<2>(Simulation<2>&);
template void end_settling_step<3>(Simulation<3>&);

}  // namespace mpm
