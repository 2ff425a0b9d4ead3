#pragma once
// What the stages of a step do, one file each. Every stage is a loop over patches.
#include "mpm/domain.hpp"

namespace mpm {

/// Update the lists of particles by cell, make and drop tiles (3.4), find where bodies may meet
/// (3.3).
template <int D>
void activate_tiles(Domain<D>& domain);

/// What the grid does not see of the particles' velocities, for transfers that take it away: XPIC.
template <int D>
void filter_velocities(Domain<D>& domain);

/// What particles of bodies on nodes of their own hardly see of the velocities of these.
template <int D>
void damp_short_waves(Domain<D>& domain);

/// Nodal mass and momentum from the particles, eqs. (2)-(3). Clears all fields of the nodes, and
/// leaves what walls with images mirror of the weight (ghost weights).
template <int D>
void map_momentum(Domain<D>& domain);
/// The pressure of each cell, for materials whose volume is averaged over it.
template <int D>
void average_pressure(Domain<D>& domain);
/// Internal nodal forces, eq. (9). (Gravity, eq. (10), is added where the nodes are advanced.)
template <int D>
void map_forces(Domain<D>& domain);
template <int D>
void map_momentum_and_forces(Domain<D>& domain);

/// What particles have given to nodes beyond walls belongs to their images.
template <int D>
void fold_momentum(Domain<D>& domain);
template <int D>
void fold_forces(Domain<D>& domain);
template <int D>
void fold_remapped(Domain<D>& domain);

/// Nodes that several patches hold get the sum of what each has there. Ranks start to tell each
/// other of it before.
template <int D>
void start_momentum(Domain<D>& domain);
template <int D>
void exchange_momentum(Domain<D>& domain);
template <int D>
void start_forces(Domain<D>& domain);
template <int D>
void exchange_forces(Domain<D>& domain);
template <int D>
void start_momentum_and_forces(Domain<D>& domain);
template <int D>
void exchange_momentum_and_forces(Domain<D>& domain);
template <int D>
void start_remapped(Domain<D>& domain);
template <int D>
void exchange_remapped(Domain<D>& domain);

/// v_i = p_i / m_i, eq. (3), with the walls; prescribed bodies have their own.
template <int D>
void find_velocities(Domain<D>& domain);
template <int D>
void find_remapped(Domain<D>& domain);

/// Forces by which bodies on nodes of their own turn as their particles would
/// (particles/kept_spin.hpp).
template <int D>
void turn_in_body(Domain<D>& domain);

/// What contact points of surfaces do to each other at the end of a step, and give to their nodes
/// in the next (surfaces/surfaces.hpp).
template <int D>
void touch_surfaces(Domain<D>& domain);
template <int D>
void load_by_surfaces(Domain<D>& domain);
template <int D>
void push_rigid_by_surfaces(Domain<D>& domain);

/// Contact of bodies: overlapped nodes, normals, gaps, eq. (5); approaching momentum removed, eqs.
/// (4), (6)-(7).
template <int D>
void contact_momentum(Domain<D>& domain);

/// Loads on surfaces, body forces, and the factors of walls that absorb.
template <int D>
void map_volumes(Domain<D>& domain);
template <int D>
void heat_gases(Domain<D>& domain);
template <int D>
void load_surfaces(Domain<D>& domain);
template <int D>
void add_body_forces(Domain<D>& domain);
template <int D>
void place_dashpots(Domain<D>& domain);
/// Springs of walls that push back what touches them.
template <int D>
void place_wall_springs(Domain<D>& domain);
/// Forces of walls that absorb.
template <int D>
void absorb_at_walls(Domain<D>& domain);
/// Forces of those springs, with their friction.
template <int D>
void touch_walls(Domain<D>& domain);

/// Contact forces with friction, eqs. (11)-(15).
template <int D>
void contact_forces(Domain<D>& domain);

/// Nodal velocities and their increments, eq. (8), with gravity and walls.
template <int D>
void advance_nodes(Domain<D>& domain);

/// Particles of bodies on nodes of their own at the end of the step, and their stress.
template <int D>
void update_in_body(Domain<D>& domain);
template <int D>
void average_in_body(Domain<D>& domain);
/// The same of the stress at the start.
template <int D>
void start_average_in_body(Domain<D>& domain);
/// A body averages no more: forces use the stress of its particles as it is, from the next step on.
template <int D>
void stop_average_in_body(Domain<D>& domain, int body);

/// For transfers that take the velocity of the grid: at nodes in contact that without eqs. (6)-(7)
/// while particles are advanced, and the corrected one again (decision 0046).
template <int D>
void release_from_contact(Domain<D>& domain);
template <int D>
void restore_contact(Domain<D>& domain);

/// Particle velocities, eq. (17).
template <int D>
void advance_particles(Domain<D>& domain);

/// Particles of rigid bodies take the rigid motion of the same momentum and angular momentum.
template <int D>
void project_rigid_velocities(Domain<D>& domain);

/// MUSL: nodal momenta anew from the particles (3.6, step 10), of bodies that deform and of others.
template <int D>
void remap_momentum(Domain<D>& domain);
template <int D>
void remap_rigid_bodies(Domain<D>& domain);
template <int D>
void advance_and_remap_particles(Domain<D>& domain);

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
template <int D>
void advance_and_move_particles(Domain<D>& domain);
template <int D>
void update_stress_last_and_move(Domain<D>& domain);
template <int D>
void update_stress_remapped_and_move(Domain<D>& domain);

/// Rigid bodies, prescribed ones too, and their particles at the end of the step.
template <int D>
void move_rigid_bodies(Domain<D>& domain);

/// What has passed between bodies, pair by pair.
template <int D>
void record_contacts(Domain<D>& domain);

/// Energies and momentum after the step; `forces_follow` if the stress was updated before the
/// forces.
template <int D, bool forces_follow>
void sum_energies(Domain<D>& domain);

}  // namespace mpm
