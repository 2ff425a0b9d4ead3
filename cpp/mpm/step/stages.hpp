#pragma once
// The stages of a step, one file each. Every stage is a loop over patches.
#include "mpm/domain.hpp"

namespace mpm {

/// Mend the lists of particles by cell, make and drop tiles (3.4), find where bodies may meet
/// (3.3).
template <int D>
void activate_tiles(Domain<D>& domain);

/// Nodal mass and velocity from the particles, eqs. (2)-(3), with the walls. Clears all fields of
/// the nodes, and leaves in the forces what slip walls mirror of the weight; nothing may write
/// there until the forces are mapped.
template <int D>
void map_momentum(Domain<D>& domain);

/// Contact of bodies: overlapped nodes, normals, gaps, eq. (5); approaching momentum removed, eqs.
/// (4), (6)-(7).
template <int D>
void contact_momentum(Domain<D>& domain);

/// Internal nodal forces, eq. (9). (Gravity, eq. (10), is added where the nodes are advanced.)
template <int D>
void map_forces(Domain<D>& domain);

/// Both at once, where no stage between them changes what the forces are made of.
template <int D>
void map_momentum_and_forces(Domain<D>& domain);

/// Forces of walls that absorb.
template <int D>
void absorb_at_walls(Domain<D>& domain);

/// Contact forces with friction, eqs. (11)-(15).
template <int D>
void contact_forces(Domain<D>& domain);

/// Nodal velocities and their increments, eq. (8), with gravity and walls.
template <int D>
void advance_nodes(Domain<D>& domain);

/// Particle velocities, eq. (17).
template <int D>
void advance_particles(Domain<D>& domain);

/// MUSL: nodal velocities anew from the particles (3.6, step 10).
template <int D>
void remap_momentum(Domain<D>& domain);

/// Both in two other stages: particles of bodies that deform give their new momentum at once; then
/// rigid bodies' do, and the nodes get their velocities.
template <int D>
void advance_and_remap_particles(Domain<D>& domain);
template <int D>
void remap_nodes(Domain<D>& domain);

/// MUSL: contact of the remapped velocities (3.6, step 10).
template <int D>
void contact_remapped(Domain<D>& domain);

/// Strain, rotation, stress, eqs. (18)-(20): USF with the velocities after the first mapping, USL
/// after the nodes have been advanced, MUSL after the remap.
template <int D>
void update_stress_first(Domain<D>& domain);
template <int D>
void update_stress_last(Domain<D>& domain);
template <int D>
void update_stress_remapped(Domain<D>& domain);

/// Particle positions, eq. (16).
template <int D>
void move_particles(Domain<D>& domain);

/// The same together with what else the particles are read for.
template <int D>
void advance_and_move_particles(Domain<D>& domain);
template <int D>
void update_stress_last_and_move(Domain<D>& domain);
template <int D>
void update_stress_remapped_and_move(Domain<D>& domain);

}  // namespace mpm
