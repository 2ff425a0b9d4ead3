#pragma once
// What passes between particles and nodes: the transfers, one line in all, and the internal force.
#include <algorithm>
#include <array>
#include <type_traits>

#include "mpm/catalogue/choice_list.hpp"
#include "mpm/domain.hpp"
#include "mpm/step/transfer/aflip.hpp"
#include "mpm/step/transfer/flip_pic.hpp"
#include "mpm/step/transfer/mapping.hpp"
#include "mpm/step/transfer/pic.hpp"
#include "mpm/step/transfer/xpic.hpp"

namespace mpm {

/// `take` has the velocity of the particle, the sum of the increments and that of the
/// velocities, if `takes_grid_velocity`; if it `filters`, what the grid has not seen of
/// the particle's velocity before the step, for which there is a column and a stage. What particles
/// lose against FLIP by the last two goes to the ledger. With `affine` particles have a column for
/// the affine part of the velocity, and `give` has first moments. `Gives` is the transfer whose
/// `give` it has.
template <class T>
concept TransferModel = requires {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::doc } -> std::convertible_to<std::string_view>;
  { T::source } -> std::convertible_to<std::string_view>;
  { T::takes_grid_velocity } -> std::convertible_to<bool>;
  { T::affine } -> std::convertible_to<bool>;
  { T::filters } -> std::convertible_to<bool>;
  { T::has_share } -> std::convertible_to<bool>;
  typename T::Gives;
};

template <TransferModel... T>
struct TransferList : ChoiceList<TransferId, T...> {
  static constexpr std::array<bool, sizeof...(T)> affine = {T::affine...};
  static constexpr std::array<bool, sizeof...(T)> filters = {T::filters...};
  static constexpr std::array<bool, sizeof...(T)> takes_grid_velocity = {T::takes_grid_velocity...};
};
using Transfers = TransferList<Flip, Pic, Apic, Aflip, Xpic>;
template <>
inline constexpr auto words<TransferId> = Transfers::words_of();

/// Have its particles an affine part of the velocity?
constexpr bool is_affine(TransferId id) { return Transfers::affine[static_cast<std::size_t>(id)]; }
/// Do they take the velocity of the grid?
constexpr bool takes_grid_velocity(TransferId id) {
  return Transfers::takes_grid_velocity[static_cast<std::size_t>(id)];
}
/// Is a part of their velocity filtered out?
constexpr bool filters(TransferId id) { return Transfers::filters[static_cast<std::size_t>(id)]; }
/// `in_body`: of bodies on nodes of their own, which no transfer acts on.
constexpr TransferColumns columns_of(TransferId id, bool in_body = false) {
  if (in_body) return {.reference = true};
  return {.affine = is_affine(id), .unseen = filters(id)};
}
/// Is it in the step being made? Steps count from the start of the run, restarts or not.
template <int D>
bool filters_now(const Domain<D>& domain) {
  return filters(domain.transfer) && (domain.step + 1) % domain.filter_every == 0;
}

/// What the share of a transfer depends on of a material.
struct TransferShare {
  double own;   // the step over its own, see share_of()
  double flip;  // FLIP's share in a step of its own
};

/// Of a material. Its own step is that in which its fastest wave and particle together pass half a
/// cell, as they do at the default `cfl` where it is alone. The noise of a gas grows with the share
/// of AFLIP that solids need (decision 0065). Bonded bodies take the same number of it: where a
/// solid is among them its waves are the gas's as well.
template <int D>
TransferShare share_of(const Domain<D>& domain, const ParticlePool<D>& pool) {
  const auto is_gas = [](const ParticlePool<D>& of) { return of.matter == Matter::gas; };
  const bool gas = domain.grid.bonded ? std::ranges::all_of(domain.pools, is_gas) : is_gas(pool);
  return {domain.time_step * pool.fastest / (0.5 * domain.grid.cell_size),
          gas ? domain.flip_share_of_gases : domain.flip_share};
}

/// Of a solid that makes the step: for what depends only on whether there is a share at all.
template <int D>
TransferShare any_share(const Domain<D>& domain) {
  return {1.0, domain.flip_share};
}

/// f(transfer) for that of the run, of a material with that share (share_of(), any_share()).
// The share of AFLIP is a matter of its own step: where a stiff body makes steps that are short for
// a soft one, the same share in each would take as many times more (decision 0055).
template <int D, class F>
void with_transfer(const Domain<D>& domain, TransferShare of, F&& f) {
  // A rate times the step, so that the damping in time does not depend on the steps' length; 1 is
  // PIC.
  const double damped = domain.pic_rate * domain.time_step;
  const double share = std::min(damped + 1.0 - of.flip, 1.0);
  Transfers::with(domain.transfer, [&]<class T>(const T& transfer) {
    if constexpr (std::is_same_v<T, Flip>)
      // Without damping the grid's velocity is not even read.
      if (share > 0.0) return f(FlipPic(share));
    if constexpr (T::filters)
      if (!filters_now(domain)) return f(Flip());
    if constexpr (std::is_same_v<T, Aflip>)
      f(Aflip(std::max(1.0 - (1.0 - of.flip) * of.own - damped, 0.0)));
    else
      f(transfer);
  });
}

/// The transfer by which particles take their velocity, to the same bits: PIC and APIC are those
/// with a share at one end of it, so that the loops over particles are not compiled for them too.
template <TransferModel T>
auto taken_by(const T& transfer) {
  if constexpr (std::is_same_v<T, Pic>)
    return FlipPic(1.0);
  else if constexpr (std::is_same_v<T, Apic>)
    return Aflip(0.0);
  else
    return transfer;
}

/// The share of the grid's velocity in that which particles take; the rest is FLIP.
template <int D>
double grid_share(const Domain<D>& domain, TransferShare of) {
  double share = 0.0;
  with_transfer(domain, of, [&]<class T>(const T& transfer) {
    if constexpr (T::takes_grid_velocity) share = transfer.take(0.0, 0.0, 1.0);
  });
  return share;
}

/// f(transfer) likewise, of a basis with which it goes: others were refused.
template <BasisModel B, int D, class F>
void with_transfer_for(const Domain<D>& domain, TransferShare of, F&& f) {
  with_transfer(domain, of, [&]<class T>(const T& transfer) {
    if constexpr (!T::affine || B::second_moment > 0.0) f(transfer);
  });
}

}  // namespace mpm
