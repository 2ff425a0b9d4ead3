#include "mpm/run/start_contact.hpp"

#include "mpm/contact/set_back.hpp"
#include "mpm/particles/make_body.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void add_contact_columns(Domain<D>& domain) {
  if (!domain.has_springs()) return;
  for (ParticlePool<D>& pool : domain.pools) add_set_back(pool);
}

template <int D>
void start_contact(Domain<D>& domain) {
  if (!domain.has_springs()) return;
  map_momentum(domain);
  fold_momentum(domain);
  exchange_momentum(domain);
  find_velocities(domain);
  contact_momentum(domain);
  set_back_surfaces(domain.contact, domain.grid, domain.bodies, domain.pools,
                    domain.contact_settings, domain.threads);
}

template void add_contact_columns<2>(Domain<2>&);
template void add_contact_columns<3>(Domain<3>&);
template void start_contact<2>(Domain<2>&);
template void start_contact<3>(Domain<3>&);

}  // namespace mpm
