#pragma once
// READ THIS FIRST. A step is a list of stages: usf, usl, musl, in the order of section 3.6 of Ma,
// Zhang & Huang (2010). The lists are data: the time loop runs them, timers and tests name them.
// What runs is the same lists with some neighbours fused, so that particles are read fewer times.
#include <span>

#include "mpm/catalogue/words.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

/// When the stress is updated.
enum class Scheme { usf, usl, musl };
template <>
inline constexpr auto words<Scheme> = std::to_array<Word<Scheme>>(
    {{"usf", Scheme::usf, "first (Bardenhagen 2002)"},
     {"usl", Scheme::usl, "last (Sulsky, Chen & Schreyer 1994)"},
     {"musl", Scheme::musl, "last, with remapped velocities (Sulsky, Zhou & Schreyer 1995)"}});

/// Stages that are there for some transfers alone. Release: they take the velocity of the grid, and
/// bodies may meet. Filter: a part of the particles' velocity is taken away.
enum class Extra { none, release, filter };

template <int D>
struct Schemes {
  using S = Stages<D>;

  // clang-format off
  /// Update stress first (Bardenhagen 2002): strains with the v_i that were mapped, after contact,
  /// so that this step's forces are those of the new stress, and both do the same work.
  static constexpr StageList<D> usf = std::array{
      S::activate,
      S::filter,
      S::damp_short_waves,
      S::map_momentum,
      S::fold_momentum,
      S::exchange_momentum,
      S::find_velocities,
      S::contact_momentum,
      S::update_first,
      S::average_pressure,
      S::map_forces,
      S::map_volumes,
      S::load_surfaces,
      S::load_by_surfaces,
      S::add_body_forces,
      S::place_dashpots,
      S::place_springs,
      S::fold_forces,
      S::exchange_forces,
      S::turn_in_body,
      S::absorb,
      S::touch,
      S::contact_forces,
      S::advance_nodes,
      S::heat_gases,
      S::update_in_body,
      S::average_in_body,
      S::release,
      S::advance_particles,
      S::push_rigid,
      S::hold_rigid,
      S::restore,
      S::move_particles,
      S::move_rigid,
      S::touch_surfaces,
      S::record_contacts,
      S::template sum_energies<true>,
  };

  /// Update stress last (Sulsky, Chen & Schreyer 1994): strains with v_i + dv_i. Unstable where
  /// particles enter empty cells, as dv_i is huge at a node of almost no mass.
  static constexpr StageList<D> usl = std::array{
      S::activate,
      S::filter,
      S::damp_short_waves,
      S::map_momentum,
      S::fold_momentum,
      S::exchange_momentum,
      S::find_velocities,
      S::contact_momentum,
      S::average_pressure,
      S::map_forces,
      S::map_volumes,
      S::load_surfaces,
      S::load_by_surfaces,
      S::add_body_forces,
      S::place_dashpots,
      S::place_springs,
      S::fold_forces,
      S::exchange_forces,
      S::turn_in_body,
      S::absorb,
      S::touch,
      S::contact_forces,
      S::advance_nodes,
      S::heat_gases,
      S::update_in_body,
      S::average_in_body,
      S::release,
      S::advance_particles,
      S::push_rigid,
      S::hold_rigid,
      S::restore,
      S::update_last,
      S::move_particles,
      S::move_rigid,
      S::touch_surfaces,
      S::record_contacts,
      S::template sum_energies<false>,
  };

  /// Modified update stress last (Sulsky, Zhou & Schreyer 1995): strains with velocities mapped
  /// anew from the advanced particles (3.6, step 10), with approach removed again. Positions move
  /// with v_i + dv_i all the same, eq. (16).
  static constexpr StageList<D> musl = std::array{
      S::activate,
      S::filter,
      S::damp_short_waves,
      S::map_momentum,
      S::fold_momentum,
      S::exchange_momentum,
      S::find_velocities,
      S::contact_momentum,
      S::average_pressure,
      S::map_forces,
      S::map_volumes,
      S::load_surfaces,
      S::load_by_surfaces,
      S::add_body_forces,
      S::place_dashpots,
      S::place_springs,
      S::fold_forces,
      S::exchange_forces,
      S::turn_in_body,
      S::absorb,
      S::touch,
      S::contact_forces,
      S::advance_nodes,
      S::heat_gases,
      S::update_in_body,
      S::average_in_body,
      S::release,
      S::advance_particles,
      S::push_rigid,
      S::hold_rigid,
      S::remap_momentum,
      S::remap_rigid,
      S::restore,
      S::fold_remapped,
      S::exchange_remapped,
      S::find_remapped,
      S::contact_remapped,
      S::update_remapped,
      S::move_particles,
      S::move_rigid,
      S::touch_surfaces,
      S::record_contacts,
      S::template sum_energies<false>,
  };

  // clang-format on
  // With USF the stress lies between momentum and forces, which is why these are not mapped at once
  // (decision 0034).
  static constexpr StageList<D> usl_fused =
      fuse(usl, S::map_both, S::exchange_both, S::update_last_and_move);
  static constexpr StageList<D> musl_fused =
      fuse(musl, S::map_both, S::exchange_both, S::advance_and_remap, S::update_remapped_and_move);

  /// The list as a transfer wants it: those of the velocity of the grid release particles from
  /// contact's correction, XPIC filters; and with or without bodies on nodes of their own.
  static constexpr StageList<D> with(const StageList<D>& list, Extra extra, bool in_body) {
    StageList<D> rest = list;
    if (extra != Extra::filter) rest = without(rest, S::filter);
    if (extra != Extra::release) rest = without(without(rest, S::release), S::restore);
    if (in_body) return rest;
    for (const Stage<D>& stage :
         {S::damp_short_waves, S::load_by_surfaces, S::turn_in_body, S::update_in_body,
          S::average_in_body, S::push_rigid, S::touch_surfaces})
      rest = without(rest, stage);
    return rest;
  }
  using ByExtra = std::array<StageList<D>, 3>;
  using Lists = std::array<ByExtra, 2>;  // without and with such bodies
  static constexpr ByExtra with_each(const StageList<D>& list, bool in_body) {
    return {with(list, Extra::none, in_body), with(list, Extra::release, in_body),
            with(list, Extra::filter, in_body)};
  }
  static constexpr Lists with_each(const StageList<D>& list) {
    return {with_each(list, false), with_each(list, true)};
  }
  static constexpr std::array<Lists, 3> plain = {with_each(usf), with_each(usl), with_each(musl)};
  // Particles that are released are moved with the corrected velocity and advanced with another:
  // with USF they are read twice.
  static constexpr ByExtra usf_fused(bool in_body) {
    return {fuse(with(usf, Extra::none, in_body), S::advance_and_move),
            with(usf, Extra::release, in_body),
            fuse(with(usf, Extra::filter, in_body), S::advance_and_move)};
  }
  static constexpr std::array<Lists, 3> fused = {Lists{usf_fused(false), usf_fused(true)},
                                                 with_each(usl_fused), with_each(musl_fused)};
};

/// The stages of a step, as a scheme lists them or with neighbours fused, to the same bits;
/// `in_body`: there are bodies on nodes of their own.
template <int D>
std::span<const Stage<D>> stages_of(Scheme scheme, bool fused, Extra extra = Extra::none,
                                    bool in_body = false) {
  const auto& lists = fused ? Schemes<D>::fused : Schemes<D>::plain;
  const StageList<D>& list =
      lists[static_cast<std::size_t>(scheme)][in_body ? 1 : 0][static_cast<std::size_t>(extra)];
  return {list.stages.data(), list.count};
}

}  // namespace mpm
