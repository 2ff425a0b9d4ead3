#include "mpm/contact/exchange_contact.hpp"
#include "mpm/contact/find_nodes.hpp"
#include "mpm/contact/respond.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {

namespace {

/// Nodes beyond walls follow their images; contact has changed the vector at number `at` of the
/// records. Not needed for forces: what nodes beyond walls get from those is overwritten when nodes
/// are advanced.
template <int D>
void reflect(Domain<D>& domain, int at) {
  TileGrid<D>& grid = domain.grid;
  if (!grid.has_ghosts()) return;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    reflect_at_walls(grid, grid.patches[p], grid.block(p), at);
  });
}

}  // namespace

template <int D>
void contact_momentum(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  // Eqs. (4)-(7) with the velocities of the start of the step; planes and gaps are found at most
  // once a step, and hold for forces and remapped velocities too, as particles move last.
  find_nodes(domain.contact, domain.grid, domain.bodies, domain.pools, domain.contact_settings,
             domain.time_step, domain.threads);
  if (!changes_velocities(domain.contact_settings)) return;
  remove_approach(domain.contact, domain.grid, domain.threads);
  exchange_responses(domain.contact, domain.grid, velocity_at);
  reflect(domain, velocity_at);
}

template <int D>
void contact_forces(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  add_contact_forces(
      domain.contact, domain.grid,
      ContactStep<D>{domain.bodies, domain.dampings, domain.gravity, domain.time_step},
      domain.threads);
  exchange_responses(domain.contact, domain.grid, force_at);
}

template <int D>
void release_from_contact(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  release_particles(domain.contact, domain.grid, domain.threads);
  exchange_responses(domain.contact, domain.grid, velocity_at);
  reflect(domain, velocity_at);
}

template <int D>
void restore_contact(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  restore_nodes(domain.contact, domain.grid, domain.threads);
  exchange_responses(domain.contact, domain.grid, velocity_at);
  reflect(domain, velocity_at);
}

template <int D>
void contact_remapped(Domain<D>& domain) {
  if (!domain.has_contact()) return;
  find_slip(domain.contact, domain.grid, domain.threads);
  if (!changes_velocities(domain.contact_settings)) return;
  // The particles have kept v_i when they were advanced by increments, so what approach (6)-(7)
  // took from the nodes is in the remapped velocities again (3.6, step 10: "readjust").
  remove_remapped_approach(domain.contact, domain.grid, domain.threads);
  exchange_responses(domain.contact, domain.grid, remapped_at);
  reflect(domain, remapped_at);
}

template void contact_momentum<2>(Domain<2>&);
template void contact_momentum<3>(Domain<3>&);
template void contact_forces<2>(Domain<2>&);
template void contact_forces<3>(Domain<3>&);
template void release_from_contact<2>(Domain<2>&);
template void release_from_contact<3>(Domain<3>&);
template void restore_contact<2>(Domain<2>&);
template void restore_contact<3>(Domain<3>&);
template void contact_remapped<2>(Domain<2>&);
template void contact_remapped<3>(Domain<3>&);

}  // namespace mpm
