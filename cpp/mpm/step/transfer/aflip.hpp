#pragma once
#include "mpm/step/transfer/apic.hpp"

namespace mpm {

/// AFLIP: FLIP with the affine part of APIC. Of the velocity a share alpha is FLIP's.
struct Aflip : Apic {
  static constexpr std::string_view name = "aflip";
  static constexpr std::string_view doc =
      "\"flip\" with the affine part of \"apic\"; keeps what the grid does not see, as much as "
      "its share says";
  static constexpr std::string_view source = "Fei et al. 2021, eq. 19 with no change of position";
  static constexpr bool has_share = true;

  double alpha;

  MPM_HD explicit Aflip(double share = 1.0) : alpha(share) {}

  /// Where nodes of the particle lie on a fixed wall it is APIC. FLIP does not learn that the wall
  /// holds them, while C_p does: v_p of a layer that slides along the wall stays, C_p shears it,
  /// and both together give the next nodes more than any particle has (decision 0052).
  MPM_HD Aflip at_fixed_walls() const { return Aflip(0.0); }

  /// v_p = alpha (v_p + sum dv_i N_ip) + (1 - alpha) sum v_i N_ip.
  template <class T>
  MPM_HD MPM_INLINE T take(T v, T dv, T of_grid) const {
    return fma(T(alpha), (v + dv) - of_grid, of_grid);
  }
};

}  // namespace mpm
