#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void contact_momentum(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  domain.contact.find(domain.grid, domain.bodies, domain.stiffness, domain.contact_settings,
                      domain.threads);
  domain.contact.adjust_momentum(domain.grid, domain.threads);
}

template <int D>
void contact_forces(Domain<D>& domain) {
  if (domain.has_contact())
    domain.contact.add_forces(domain.grid, domain.gravity, domain.time_step, domain.threads);
}

template <int D>
void contact_remapped(Domain<D>& domain) {
  if (domain.has_contact()) domain.contact.adjust_remapped(domain.grid, domain.threads);
}

template void contact_momentum<2>(Domain<2>&);
template void contact_momentum<3>(Domain<3>&);
template void contact_forces<2>(Domain<2>&);
template void contact_forces<3>(Domain<3>&);
template void contact_remapped<2>(Domain<2>&);
template void contact_remapped<3>(Domain<3>&);

}  // namespace mpm
