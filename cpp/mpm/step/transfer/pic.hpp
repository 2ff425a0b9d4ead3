#pragma once
#include "mpm/step/transfer/flip.hpp"

namespace mpm {

/// PIC: the grid's velocity is the particle's (Harlow 1964). What the grid does not see is lost in
/// every step, however short, and the ledger counts it.
struct Pic : Flip {
  static constexpr std::string_view name = "pic";
  static constexpr std::string_view doc = "they take the velocity of the grid";
  static constexpr std::string_view source = "Harlow 1964";
  static constexpr bool takes_grid_velocity = true, has_share = false;

  /// A component of v_p after the step: v_p = sum v_i N_ip, of which `of_grid` is the sum.
  template <class T>
  MPM_HD MPM_INLINE T take(T, T, T of_grid) const {
    return of_grid;
  }
};

}  // namespace mpm
