#pragma once
#include "mpm/step/transfer/flip.hpp"

namespace mpm {

/// APIC: particles take the velocity of the grid as PIC does, and beside it its affine part, C_p,
/// so that turning and shearing are kept: angular momentum is, to rounding. For a basis whose
/// second moment D is the same everywhere.
struct Apic : Flip {
  static constexpr std::string_view name = "apic";
  static constexpr std::string_view doc =
      "they take the velocity of the grid and its affine part, which keeps angular momentum";
  static constexpr std::string_view source = "Jiang et al. 2015";
  static constexpr bool takes_grid_velocity = true, affine = true, has_share = false;
  using Gives = Apic;

  /// From particle p to node i: m_i += m_p N_ip, eq. (2); p_i += N_ip m_p (v_p + C_p (x_i - x_p)),
  /// with the first moment M_ip = N_ip (x_i - x_p).
  template <class P, class N, class M, class Node>
  MPM_HD MPM_INLINE static void give(const P& p, const N& N_ip, const M& M_ip, Node& node) {
    node.m += p.m * N_ip;
    node.p += p.mv * N_ip + p.mC * M_ip;
  }

  /// A component of v_p after the step: v_p = sum v_i N_ip, of which `of_grid` is the sum.
  template <class T>
  MPM_HD MPM_INLINE T take(T, T, T of_grid) const {
    return of_grid;
  }
};

}  // namespace mpm
