#pragma once
#include "mpm/step/transfer/flip.hpp"

namespace mpm {

/// FLIP of which a share `pic` is PIC: so much of the grid's velocity itself takes the place of the
/// particle's (Harlow 1964), and what the grid does not see dies away.
struct FlipPic : Flip {
  static constexpr bool takes_grid_velocity = true;

  double pic;

  MPM_HD explicit FlipPic(double share) : pic(share) {}

  /// v_p += sum dv_i N_ip, eq. (17), then v_p += pic (sum v_i N_ip - v_p), the latter sum
  /// `of_grid`: with all of it PIC, to the same bits.
  template <class T>
  MPM_HD MPM_INLINE T take(T v, T dv, T of_grid) const {
    // Momentum is kept, as sum m_p N_ip = m_i: the sum over particles of m_p times the grid's
    // velocity is sum m_i v_i (docs/theory/step.md, PIC damping).
    const T flip = v + dv;
    return fma(T(1.0 - pic), flip - of_grid, of_grid);
  }
};

}  // namespace mpm
