#pragma once
#include <string_view>

#include "mpm/math/vec.hpp"

namespace mpm {

/// FLIP, the paper's: particles keep their velocity and take the change of the grid's.
struct Flip {
  static constexpr std::string_view name = "flip";  // the word in a case file
  static constexpr std::string_view doc = "they take the change of the grid's velocity";
  static constexpr std::string_view source = "Brackbill & Ruppel 1986";
  static constexpr bool takes_grid_velocity = false, affine = false, filters = false;
  static constexpr bool has_share = true;  // of FLIP beside the grid's velocity, and pic_rate
  using Gives = Flip;                      // whose `give` it has

  /// From particle p to node i: m_i += m_p N_ip, eq. (2); p_i += m_p N_ip v_p, eq. (3).
  template <class P, class N, class Node>
  MPM_HD MPM_INLINE static void give(const P& p, const N& N_ip, Node& node) {
    // One product for both, so that v_i = p_i / m_i of a body that moves as one is v_p but for
    // rounding.
    const auto m_ip = p.m * N_ip;
    node.m += m_ip;
    node.p += m_ip * p.v;
  }

  /// A component of v_p after the step: v_p += sum dv_i N_ip, eq. (17), of which `dv` is the sum.
  template <class T>
  MPM_HD MPM_INLINE T take(T v, T dv) const {
    return v + dv;
  }
};

}  // namespace mpm
