#include "mpm/run/look_for_failed.hpp"

#include <algorithm>

#include "mpm/comm/all_sums.hpp"
#include "mpm/run/renew_reference.hpp"
#include "mpm/run/watch_contact.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/surfaces/uncover.hpp"

namespace mpm {
namespace {

/// Of a body of which more has failed it is told: the rest is debris.
constexpr double most_that_is_a_body = 0.25;

}  // namespace

template <int D>
void look_for_failed(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  if (domain.step % renewal_every != 0 ||
      std::ranges::none_of(domain.pools,
                           [](const ParticlePool<D>& pool) { return pool.opened >= 0; }))
    return;
  std::vector<std::int64_t>& counts = simulation.flowed;
  counts.assign(domain.bodies.size(), 0);
  for (const Patch<D>& patch : domain.grid.patches) {
    const ParticlePool<D>& pool = domain.pool_of(patch);
    if (!patch.keeps || patch.foreign || pool.opened < 0) continue;
    const double* const failed = pool.columns.component(pool.at.failed);
    for (const std::uint32_t row : pool.rows(patch))
      counts[static_cast<std::size_t>(patch.body)] += failed[row] > 0.0;
  }
  domain.grid.partition.comm->all_sum(counts);
  bool more = false;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    Body<D>& body = domain.bodies[b];
    more = more || counts[b] > body.failed;
    body.failed = counts[b];
    // Of pressures over nodes that what has failed does not bear, others would lose a part.
    if (body.failed > 0 && body.averages) stop_average_in_body(domain, static_cast<int>(b));
    const double share = static_cast<double>(body.failed) / static_cast<double>(body.count);
    if (share > most_that_is_a_body)
      note(simulation, {.kind = NoteKind::failed, .body = static_cast<int>(b), .share = share});
  }
  if (more) uncover(domain);
}

template void look_for_failed<2>(Simulation<2>&);
template void look_for_failed<3>(Simulation<3>&);

}  // namespace mpm
