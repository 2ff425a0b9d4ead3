#pragma once
#include "mpm/contact/node_forces.hpp"

namespace mpm {

/// May contact change any velocities before forces do: of pairs whose approach is stopped, eqs.
/// (6)-(7), and of bonded ones?
inline bool changes_velocities(const ContactSettings& settings) {
  return settings.response != Response::springs || bonds(settings);
}

/// Remove approaching momentum, eqs. (6)-(7), from the nodal velocities.
template <int D>
void remove_approach(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);

/// Add the contact forces, eqs. (11)-(15), to the nodal forces.
template <int D>
void add_contact_forces(Contact<D>& contact, TileGrid<D>& grid, const ContactStep<D>& step,
                        Threads& threads);

/// Between these two the nodes have the velocity without what (6)-(7) have changed: particles that
/// take the velocity of the grid are to take no part in it (decision 0046). Bonded bodies keep
/// theirs, which is that of one field. Not needed with springs.
template <int D>
void release_particles(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);
template <int D>
void restore_nodes(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);

/// The slip of the remapped velocities, for the work of friction.
template <int D>
void find_slip(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);
/// Remove the approach from the remapped velocities (3.6, step 10).
template <int D>
void remove_remapped_approach(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);

}  // namespace mpm
