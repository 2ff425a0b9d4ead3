#include <stdexcept>

#include "mpm/particles/make_body.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/run/start_affine.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {

template <int D>
void set_velocity(Simulation<D>& simulation, int number, std::span<const double> velocities) {
  Domain<D>& domain = simulation.domain;
  Body<D>& b = domain.body_at(number);
  for (const HeldBody& held : simulation.held)
    if (held.body == number)
      throw std::invalid_argument(b.name + " is held until the run has settled: set it then");
  if (b.is_prescribed()) throw std::invalid_argument("the motion of " + b.name + " is prescribed");
  if (velocities.size() != b.count * D) throw std::invalid_argument("velocities must be (n, D)");
  check_finite(velocities, "velocities");
  if (simulation.phase == Phase::building) {
    if (b.given) b.given->velocities = b.share().of(velocities, D);
    return;
  }
  require(simulation, Phase::ready, "");
  sum_by_patch(domain);
  // The affine part is found on the nodes around the particles, which the last step has moved.
  if (is_affine(domain.transfer)) activate_tiles(domain);
  const double before = kinetic_energy(domain);
  const Vector3 turned = angular_totals(part_sums(domain)).all;
  ParticlePool<D>& pool = domain.pool_of(b);
  for_each_row(domain.grid.patches, pool, number, b.removed_here, [&](std::uint32_t row) {
    for (std::size_t a = 0; a < D; ++a)
      pool.v(static_cast<int>(a))[row] = static_cast<Storage>(velocities[pool.id[row] * D + a]);
  });
  project_rigid_velocities(domain);
  std::vector<bool> meant(domain.bodies.size(), false);
  meant[static_cast<std::size_t>(number)] = true;
  start_affine(domain, meant);
  find_kept_velocities(domain, meant);
  Ledger& ledger = domain.ledger;
  const double now = kinetic_energy(domain), ahead = -kinetic_excess(domain.kept_spins);
  // Of nodes that lie in bodies: what they have more than these is another one by now.
  if (has_kept_nodes(domain))
    ledger.time_integration -= before - (ledger.kinetic - ledger.kept_ahead) - ahead;
  ledger.external += now - before;
  ledger.set_kinetic(now, ahead);
  ledger.momentum = momentum(domain);
  ledger.angular.start += angular_totals(part_sums(domain)).all - turned;
  simulation.watch.steps.start_from(ledger.made(), ledger.load_work);
  probe_speeds(domain);
  update_time_step(simulation);
  invalidate_pairs(domain.contact);  // gaps change with the velocities that particles had
}

template void set_velocity<2>(Simulation<2>&, int, std::span<const double>);
template void set_velocity<3>(Simulation<3>&, int, std::span<const double>);

}  // namespace mpm
