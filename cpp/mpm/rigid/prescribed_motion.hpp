#pragma once
// A rigid motion that a body has whatever acts on it.
#include <array>

#include "mpm/math/time_function.hpp"
#include "mpm/rigid/rigid_motion.hpp"

namespace mpm {

/// The centre moves with a velocity and the body turns about it, both functions of time. In a step
/// the velocities are their means over it, so that the displacement is the integral.
struct PrescribedMotion {
  std::array<TimeFunction, 3> velocity{}, spin{};  // [m/s], [rad/s]
  bool moves = false;                              // some function does not vanish
  double radius = 0.0;      // distance of its farthest particle from the centre [m]
  RigidMotion before, now;  // of the last step and of this one; `now.centre` is at its start [m]

  void start(const Vector3& centre, double time) {
    moves = false;
    for (std::size_t a = 0; a < 3; ++a) {
      moves = moves || !velocity[a].vanishes() || !spin[a].vanishes();
      now.velocity.c[a] = velocity[a].at(time);
      now.spin.c[a] = spin[a].at(time);
    }
    now.centre = centre;
    before = now;
  }
  void begin_step(double from, double to) {
    // The last step's mean, not its end: what nodes and particles have had, so that increments add
    // up.
    before = now;
    for (std::size_t a = 0; a < 3; ++a) {
      now.velocity.c[a] = velocity[a].mean(from, to);
      now.spin.c[a] = spin[a].mean(from, to);
    }
  }
  /// The same of a step in which it stands still.
  void stand_still() {
    now.velocity = now.spin = Vector3::zero();
    before = now;
  }
  /// Bound of the speed of the body's particles in a step from `from` to `to` [m/s], for the time
  /// step: a function of time may jump, so the last step's speed is none.
  double speed(double from, double to) const {
    Vector3 v, w;
    for (std::size_t a = 0; a < 3; ++a) {
      v.c[a] = velocity[a].mean(from, to);
      w.c[a] = spin[a].mean(from, to);
    }
    return norm(v) + radius * norm(w);
  }
  /// Change of the velocity from the last step to this one, at a point [m/s].
  Vector3 increment_at(const Vector3& x) const {
    return now.velocity_at(x) - before.velocity_at(x);
  }
};

/// A point or a vector of the plane as one of space.
template <int D>
Vector3 in_space(const Vec<double, D>& x) {
  Vector3 r = Vector3::zero();
  for (int a = 0; a < D; ++a) r[a] = x[a];
  return r;
}
/// The first D components of a vector.
template <int D>
Vec<double, D> from_space(const Vector3& x) {
  Vec<double, D> r;
  for (int a = 0; a < D; ++a) r[a] = x[a];
  return r;
}

}  // namespace mpm
