#pragma once
// The stages of a step as rows: each names one and says what it reads and writes.
#include "mpm/step/stage.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {

template <int D>
constexpr Stage<D> update_stress_row(void (*run)(Domain<D>&), std::uint64_t straining) {
  return {"update stress",
          run,
          Data::lists | Data::position | Data::velocity | Data::mass | Data::volume | Data::stress |
              Data::load_pieces | Data::patch_sums | Data::flowing | straining,
          Data::volume | Data::stress | Data::load_pieces | Data::patch_sums | Data::flowing,
          true,
          true};
}

/// The rows. What a stage adds to it also reads.
template <int D>
struct Stages : Data {
  using Row = Stage<D>;
  static constexpr std::uint64_t of_particles = position | velocity | mass,
                                 of_rigid = rigid_position | rigid_velocity;

  // The nodes are written as their memory is lent to the lists until momentum is mapped.
  static constexpr Row activate{
      "activate tiles", mpm::activate_tiles<D>,
      of_particles | of_rigid | volume | stress | load_pieces | body_force | unseen |
          force_pressure | lists | left_cells | patch_sums | impulses | mapped_impulses | affine |
          carried_sums | flowing,
      of_particles | of_rigid | volume | stress | load_pieces | body_force | unseen |
          force_pressure | lists | left_cells | patch_sums | impulses | mapped_impulses | affine |
          carried_sums | flowing | node_mass | node_velocity | node_force};
  // Before momentum is mapped, so that it has the nodes for itself and nothing of contact's
  // correction; velocities stay until they are advanced, as the energies are those of FLIP's step.
  static constexpr Row filter{"filter velocities", mpm::filter_velocities<D>, lists | of_particles,
                              unseen | node_mass | node_velocity, true};
  // Likewise, with the places of the forces for itself.
  static constexpr Row damp_short_waves{"damp short waves in bodies", mpm::damp_short_waves<D>,
                                        lists | mass | kept_nodes | kept_spins | patch_sums,
                                        kept_nodes | kept_spins | patch_sums | node_force, true};
  static constexpr Row map_momentum{
      "map momentum",
      mpm::map_momentum<D>,
      lists | of_particles | affine | of_rigid,
      node_mass | node_momentum | ghost_weights | node_dashpots | node_springs | node_volumes,
      true,
      true};
  static constexpr Row fold_momentum{"fold momentum",
                                     mpm::fold_momentum<D>,
                                     node_mass | node_momentum | mapped_impulses,
                                     node_mass | node_momentum | mapped_impulses,
                                     false,
                                     true};
  // The mass with the momentum: v_i of a node that patches share is the mean over all its
  // particles.
  static constexpr Row exchange_momentum{"exchange momentum",
                                         mpm::exchange_momentum<D>,
                                         node_mass | node_momentum,
                                         node_mass | node_momentum,
                                         false,
                                         false,
                                         mpm::start_momentum<D>};
  static constexpr Row find_velocities{"find velocities", mpm::find_velocities<D>,
                                       node_mass | node_momentum | mapped_impulses,
                                       node_velocity | mapped_impulses};
  // Volumes and positions for gaps and normals, eq. (5); it changes velocities and no mass.
  static constexpr Row contact_momentum{
      "contact momentum", mpm::contact_momentum<D>,
      lists | position | rigid_position | mass | volume | node_mass | node_velocity | contacts,
      node_velocity | contacts};
  static constexpr Row average_pressure{"average pressure",
                                        mpm::average_pressure<D>,
                                        lists | volume | stress,
                                        force_pressure,
                                        false,
                                        true};
  // The weights it reads are in the places of the forces, and stay in the sum (map_to_nodes.cpp).
  static constexpr Row map_forces{
      "map forces",
      mpm::map_forces<D>,
      lists | position | volume | stress | deformation | force_pressure | ghost_weights,
      node_force,
      true,
      true};
  static constexpr Row map_volumes{
      "map volumes", mpm::map_volumes<D>, lists | position | volume | flowing, node_volumes, false,
      true};
  // While a run settles the sizes of what they apply are summed as well.
  static constexpr Row load_surfaces{"load surfaces", mpm::load_surfaces<D>,
                                     lists | position | deformation | kept_nodes | load_pieces |
                                         node_force | impulses | patch_sums,
                                     load_pieces | node_force | impulses | patch_sums};
  static constexpr Row load_by_surfaces{
      "forces of surfaces", mpm::load_by_surfaces<D>,
      lists | position | surfaces | node_force | impulses | patch_sums,
      surfaces | node_force | impulses | patch_sums};
  static constexpr Row add_body_forces{
      "body forces",
      mpm::add_body_forces<D>,
      lists | position | mass | body_force | node_force | impulses | patch_sums,
      body_force | node_force | impulses | patch_sums,
      false,
      true};
  // Between the mappings and the exchange, as dashpots and loads are sums over particles as well.
  static constexpr Row place_dashpots{"place dashpots",
                                      mpm::place_dashpots<D>,
                                      lists | position | mass | node_dashpots,
                                      node_dashpots,
                                      false,
                                      true};
  static constexpr Row place_springs{"place springs of walls",
                                     mpm::place_wall_springs<D>,
                                     lists | position | volume | node_springs,
                                     node_springs,
                                     false,
                                     true};
  static constexpr Row fold_forces{"fold forces",
                                   mpm::fold_forces<D>,
                                   node_force | node_volumes | impulses,
                                   node_force | node_volumes | impulses,
                                   false,
                                   true};
  static constexpr Row exchange_forces{"exchange forces",
                                       mpm::exchange_forces<D>,
                                       node_force | node_dashpots | node_springs | node_volumes,
                                       node_force | node_dashpots | node_springs | node_volumes,
                                       false,
                                       false,
                                       mpm::start_forces<D>};
  // When all forces are there, at nodes that have them from all patches; those of followers go to
  // who leads first.
  static constexpr Row turn_in_body{
      "turn bodies on nodes of their own", mpm::turn_in_body<D>,
      lists | node_force | kept_nodes | kept_spins | surfaces | patch_sums | impulses,
      node_force | kept_spins | patch_sums | impulses};
  // After the exchange, as the force of a dashpot is not linear in C_i and m_i; before contact,
  // which balances all other forces of two bodies, eq. (13).
  static constexpr Row absorb{"absorb at walls", mpm::absorb_at_walls<D>,
                              node_mass | node_velocity | node_force | node_dashpots,
                              node_force | node_dashpots};
  // Before contact as well, which knows all other forces so; after absorbing walls, as friction
  // holds against all of them.
  static constexpr Row touch{"touch walls", mpm::touch_walls<D>,
                             node_mass | node_velocity | node_force | node_springs | patch_sums,
                             node_force | node_springs | patch_sums};
  static constexpr Row contact_forces{"contact forces", mpm::contact_forces<D>,
                                      node_mass | node_velocity | node_force | contacts,
                                      node_force | contacts};
  // It reads pieces and body forces for the work of these, once increments are known.
  static constexpr Row advance_nodes{
      "advance nodes", mpm::advance_nodes<D>,
      lists | position | mass | deformation | load_pieces | body_force | surfaces | node_mass |
          node_velocity | node_force | node_dashpots | node_springs | node_volumes | kept_nodes |
          patch_sums | impulses,
      node_velocity | node_increments | node_volumes | kept_nodes | patch_sums | impulses};
  // Of bodies on nodes of their own alone, which hold all there is of their motion.
  static constexpr Row update_in_body{
      "update in the body", mpm::update_in_body<D>,
      lists | position | mass | volume | stress | deformation | force_pressure | kept_nodes |
          patch_sums,
      position | velocity | volume | stress | deformation | patch_sums, true};
  // Of the new stress, for the forces of the next step.
  static constexpr Row average_in_body{
      "average pressure in bodies", mpm::average_in_body<D>,
      lists | velocity | mass | volume | stress | kept_nodes | patch_sums,
      force_pressure | kept_nodes | patch_sums};
  // With the velocities that strain, before particles are released from what contact has corrected.
  static constexpr Row heat_gases{"heat gases",
                                  mpm::heat_gases<D>,
                                  lists | position | mass | volume | stress | flowing |
                                      node_velocity | node_increments | patch_sums,
                                  flowing | patch_sums,
                                  false,
                                  true};
  static constexpr Row release{"release from contact", mpm::release_from_contact<D>,
                               node_velocity | node_increments | contacts,
                               node_velocity | contacts};
  static constexpr Row restore{"restore contact", mpm::restore_contact<D>, node_velocity | contacts,
                               node_velocity | contacts};
  static constexpr Row advance_particles{"advance particles",
                                         mpm::advance_particles<D>,
                                         lists | of_particles | volume | affine | of_rigid |
                                             unseen | flowing | node_velocity | node_increments |
                                             node_volumes | patch_sums,
                                         velocity | affine | flowing | rigid_velocity | patch_sums,
                                         true,
                                         true};
  static constexpr Row push_rigid{"push rigid bodies by surfaces", mpm::push_rigid_by_surfaces<D>,
                                  lists | of_rigid | surfaces | patch_sums,
                                  rigid_velocity | patch_sums};
  // Before anything takes their velocities: the remap in MUSL, the end of the step in the others.
  static constexpr Row hold_rigid{"project rigid velocities", mpm::project_rigid_velocities<D>,
                                  lists | of_rigid | patch_sums | impulses,
                                  rigid_velocity | patch_sums | impulses};
  static constexpr Row remap_momentum{"remap momentum",
                                      mpm::remap_momentum<D>,
                                      lists | of_particles | affine,
                                      node_remapped | node_volumes,
                                      true,
                                      true};
  // Apart from that of others, so that theirs can be fused with eq. (17) while rigid bodies wait
  // for their motion (decision 0034).
  static constexpr Row remap_rigid{"remap rigid bodies",
                                   mpm::remap_rigid_bodies<D>,
                                   lists | of_rigid,
                                   node_remapped,
                                   false,
                                   true};
  static constexpr Row fold_remapped{
      "fold remapped", mpm::fold_remapped<D>, node_remapped, node_remapped, false, true};
  static constexpr Row exchange_remapped{
      "exchange remapped",   mpm::exchange_remapped<D>, node_remapped, node_remapped, false, false,
      mpm::start_remapped<D>};
  static constexpr Row find_remapped{"find remapped velocities", mpm::find_remapped<D>,
                                     node_mass | node_velocity | node_remapped, node_remapped};
  static constexpr Row contact_remapped{"contact remapped", mpm::contact_remapped<D>,
                                        node_remapped | contacts, node_remapped | contacts};
  // Last of what reads nodes: until here weights are those of the mapping. It marks
  // patches that a particle has left its cell in.
  static constexpr Row move_particles{"move particles", mpm::move_particles<D>,
                                      lists | position | mass | affine | node_velocity,
                                      position | affine | left_cells | carried_sums, true};
  static constexpr Row move_rigid{"move rigid bodies", mpm::move_rigid_bodies<D>,
                                  lists | of_rigid | patch_sums,
                                  of_rigid | left_cells | patch_sums};
  // Where bodies are by now, with the velocities that have brought them there.
  static constexpr Row touch_surfaces{"touch surfaces", mpm::touch_surfaces<D>,
                                      lists | of_particles | affine | volume | stress | of_rigid |
                                          deformation | kept_nodes | kept_spins | surfaces |
                                          records | patch_sums,
                                      kept_spins | surfaces | records | patch_sums};
  static constexpr Row record_contacts{"record contacts", mpm::record_contacts<D>,
                                       node_mass | contacts | records, records};
  template <bool forces_follow>
  static constexpr Row sum_energies{
      "sum energies", mpm::sum_energies<D, forces_follow>,
      patch_sums | carried_sums | impulses | mapped_impulses | records | energies, energies};

  static constexpr Row update_first =
      update_stress_row<D>(mpm::update_stress_first<D>, node_velocity);
  static constexpr Row update_last =
      update_stress_row<D>(mpm::update_stress_last<D>, node_velocity);
  static constexpr Row update_remapped =
      update_stress_row<D>(mpm::update_stress_remapped<D>, node_remapped);

  static constexpr Fusion<D> map_both{map_momentum, map_forces, "map momentum and forces",
                                      mpm::map_momentum_and_forces<D>};
  static constexpr Fusion<D> exchange_both{
      exchange_momentum, exchange_forces, "exchange momentum and forces",
      mpm::exchange_momentum_and_forces<D>, mpm::start_momentum_and_forces<D>};
  static constexpr Fusion<D> advance_and_remap{advance_particles, remap_momentum,
                                               "advance and remap particles",
                                               mpm::advance_and_remap_particles<D>};
  static constexpr Fusion<D> advance_and_move{advance_particles, move_particles,
                                              "advance and move particles",
                                              mpm::advance_and_move_particles<D>};
  static constexpr Fusion<D> update_last_and_move{update_last, move_particles,
                                                  "update stress, move particles",
                                                  mpm::update_stress_last_and_move<D>};
  static constexpr Fusion<D> update_remapped_and_move{update_remapped, move_particles,
                                                      "update stress, move particles",
                                                      mpm::update_stress_remapped_and_move<D>};
};

}  // namespace mpm
