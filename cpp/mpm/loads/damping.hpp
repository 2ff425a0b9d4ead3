#pragma once
// Damping of a body's motion at its nodes, beside that of its material: in proportion to the mass,
// and local, in proportion to the force that is out of balance.
#include <cstddef>
#include <vector>

#include "mpm/loads/damped_node.hpp"
#include "mpm/math/time_function.hpp"

namespace mpm {

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

}  // namespace mpm
