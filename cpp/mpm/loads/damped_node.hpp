#pragma once
// A node of which the body's motion is damped.
#include <algorithm>
#include <cmath>

#include "mpm/math/host_device.hpp"

namespace mpm {

/// That of a step.
struct StepDamping {
  double rate = 0.0;   // alpha, of the mass [1/s]
  double local = 0.0;  // kappa, of the force that is out of balance

  MPM_HD bool acts() const { return rate > 0.0 || local > 0.0; }
  /// alpha dt / 2, by which a node is the more inert for the drag at the end of the step.
  MPM_HD double half_drag(double time_step) const { return 0.5 * rate * time_step; }
};

/// What a damped node does in a step along an axis.
struct DampedNode {
  double increment;  // of its velocity [m/s]
  double damping;    // force on it [N]
};

/// m dv / dt = F + l - alpha m v', v' = v + dv / 2 being the velocity in the middle of the step and
/// l = -kappa |F| sgn v' (Cundall 1987). Both by v': so alpha dt may be as large as it likes, v'
/// falls to no more than rest by l, which is less than kappa |F| then, as friction is, and neither
/// force ever gives energy.
MPM_HD inline DampedNode advance_damped(const StepDamping& damping, double m, double v, double F,
                                        double time_step) {
  const double half = 0.5 * time_step / m, drag = damping.half_drag(time_step);
  const double free = v + half * F;  // v' but for a positive factor if nothing damped
  const double l =
      -std::copysign(std::min(damping.local * std::abs(F), std::abs(free) / half), free);
  const double increment = (2.0 * half * (F + l) - 2.0 * drag * v) / (1.0 + drag);
  return {increment, l - damping.rate * m * (v + 0.5 * increment)};
}

}  // namespace mpm
