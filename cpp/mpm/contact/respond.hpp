#pragma once
#include "mpm/contact/node_forces.hpp"

namespace mpm {

/// Remove approaching momentum, eqs. (6)-(7), from the nodal velocities.
template <int D>
void remove_approach(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);

/// Add the contact forces, eqs. (11)-(15), to the nodal forces.
template <int D>
void add_contact_forces(Contact<D>& contact, TileGrid<D>& grid, const ContactStep<D>& step,
                        Threads& threads);

/// Between these two the nodes have the velocity without what (6)-(7) have changed: particles that
/// take the velocity of the grid are to take no part in it (decision 0046).
template <int D>
void release_particles(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);
template <int D>
void restore_nodes(Contact<D>& contact, TileGrid<D>& grid, Threads& threads);

/// The slip of the remapped velocities, for the work of friction; remove the approach from them
/// (3.6, step 10) if it is to be stopped.
template <int D>
void respond_to_remapped(Contact<D>& contact, TileGrid<D>& grid, bool stop_approach,
                         Threads& threads);

}  // namespace mpm
