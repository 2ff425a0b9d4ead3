#pragma once
// Damping of a body's motion at its nodes, beside that of its material: in proportion to the mass,
// and local, in proportion to the force that is out of balance.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mpm/math/time_function.hpp"

namespace mpm {

/// That of a step.
struct StepDamping {
  double rate = 0.0;   // alpha, of the mass [1/s]
  double local = 0.0;  // kappa, of the force that is out of balance

  bool acts() const { return rate > 0.0 || local > 0.0; }
  /// alpha dt / 2, by which a node is the more inert for the drag at the end of the step.
  double half_drag(double time_step) const { return 0.5 * rate * time_step; }
};

/// As functions of time, for all bodies that share it.
struct Damping {
  TimeFunction rate, local;
  StepDamping now;  // of the step being made: the means over it

  void begin_step(double from, double to) { now = {rate.mean(from, to), local.mean(from, to)}; }
};

/// Of the step being made, by a body's number for it, which is negative for none.
inline StepDamping damping_in(const std::vector<Damping>& dampings, int number) {
  return number < 0 ? StepDamping{} : dampings[static_cast<std::size_t>(number)].now;
}

/// What a damped node does in a step along an axis.
struct DampedNode {
  double increment;  // of its velocity [m/s]
  double damping;    // force on it [N]
};

/// m dv / dt = F + l - alpha m v', v' = v + dv / 2 being the velocity in the middle of the step and
/// l = -kappa |F| sgn v' (Cundall 1987). Both by v': so alpha dt may be as large as it likes, v'
/// falls to no more than rest by l, which is less than kappa |F| then, as friction is, and neither
/// force ever gives energy.
inline DampedNode advance_damped(const StepDamping& damping, double m, double v, double F,
                                 double time_step) {
  const double half = 0.5 * time_step / m, drag = damping.half_drag(time_step);
  const double free = v + half * F;  // v' but for a positive factor if nothing damped
  const double l =
      -std::copysign(std::min(damping.local * std::abs(F), std::abs(free) / half), free);
  const double increment = (2.0 * half * (F + l) - 2.0 * drag * v) / (1.0 + drag);
  return {increment, l - damping.rate * m * (v + 0.5 * increment)};
}

}  // namespace mpm
