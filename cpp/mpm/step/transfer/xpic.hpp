#pragma once
#include "mpm/step/transfer/flip.hpp"

namespace mpm {

/// XPIC(k): FLIP, and of the velocity before the step (I - S S+)^k V is taken away, what k maps to
/// the grid and back do not see of it; "filter velocities" has found it. With k = 1 this is PIC.
struct Xpic : Flip {
  static constexpr std::string_view name = "xpic";
  static constexpr std::string_view doc =
      "\"flip\" without what the grid does not see of their velocity, the more exactly the larger "
      "the order";
  static constexpr std::string_view source = "Hammerquist & Nairn 2017";
  static constexpr bool filters = true, has_share = false;

  /// A component of v_p after the step: v_p + sum dv_i N_ip - u_p, with u = (I - S S+)^k V.
  template <class T>
  MPM_HD MPM_INLINE T take(T v, T dv, T unseen) const {
    return (v + dv) - unseen;
  }
};

}  // namespace mpm
