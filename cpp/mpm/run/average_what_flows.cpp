#include "mpm/run/average_what_flows.hpp"

#include <algorithm>

#include "mpm/run/particles_that_flow.hpp"
#include "mpm/run/renew_reference.hpp"

namespace mpm {
namespace {

/// Plastic strain beyond which a metal is said to flow, of tensile tests (ISO 6892).
constexpr double proof_strain = 0.002;

template <int D>
bool waits(const Domain<D>& domain, const Body<D>& body) {
  const Material& material = domain.materials[static_cast<std::size_t>(body.material)];
  return body.keeps_nodes() && material.averages_volume && !body.averages && body.failed == 0;
}

}  // namespace

template <int D>
void average_what_flows(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  if (domain.step % renewal_every != 0 ||
      std::ranges::none_of(domain.bodies, [&](const Body<D>& body) { return waits(domain, body); }))
    return;
  const auto flows = [](const Body<D>&, const ParticlePool<D>& pool, std::uint32_t row) {
    return flowed_since(pool, row) >= proof_strain;
  };
  std::vector<std::int64_t>& counts = simulation.flowed;
  count_that_flow(domain, counts, flows);
  for (std::size_t b = 0; b < domain.bodies.size(); ++b)
    if (Body<D>& body = domain.bodies[b]; waits(domain, body) && are_many(body, counts[b]))
      body.averages = true;
}

template void average_what_flows<2>(Simulation<2>&);
template void average_what_flows<3>(Simulation<3>&);

}  // namespace mpm
