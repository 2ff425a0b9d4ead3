#pragma once
// The work of one of the forces on a patch's nodes over a step.

namespace mpm {

/// Time step x sum of force . velocity before the nodes were advanced, and half of force .
/// increment; both together are the work with the velocity in the middle of the step.
struct Work {
  double first = 0.0, second = 0.0;  // [J]

  Work& operator+=(const Work& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

}  // namespace mpm
