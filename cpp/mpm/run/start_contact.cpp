#include "mpm/run/start_contact.hpp"

#include "mpm/contact/find_touches.hpp"
#include "mpm/contact/guests.hpp"
#include "mpm/contact/set_back.hpp"
#include "mpm/particles/add_columns.hpp"
#include "mpm/surfaces/pressing.hpp"
#include "mpm/walls/set_back.hpp"

namespace mpm {

template <int D>
void add_contact_columns(Domain<D>& domain) {
  if (particles_press(domain))
    for (const Body<D>& body : domain.bodies) {
      ParticlePool<D>& pool = domain.pool_of(body);
      if (body.kind == BodyKind::deformable && pool.pressing.force < 0) add_pressing(pool);
    }
  if (!domain.has_springs() && !domain.grid.has_wall_springs) return;
  for (ParticlePool<D>& pool : domain.pools) add_set_back(pool);
}

template <int D>
void start_contact(Domain<D>& domain) {
  if (domain.has_contact())
    exchange_guests(domain.contact, domain.grid, domain.bodies, domain.pools);
  if (domain.has_springs()) {
    find_touches(domain.contact, domain.grid, domain.bodies, domain.pools, domain.contact_settings,
                 domain.threads, false);
    set_back_surfaces(domain.contact, domain.bodies, domain.pools, domain.contact_settings,
                      domain.grid.cell_size);
  }
  set_back_at_walls(domain);
}

template void add_contact_columns<2>(Domain<2>&);
template void add_contact_columns<3>(Domain<3>&);
template void start_contact<2>(Domain<2>&);
template void start_contact<3>(Domain<3>&);

}  // namespace mpm
