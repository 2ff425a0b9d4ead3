#pragma once
// What acts between bodies, and on bodies as wholes, in the coming step: plain data.
#include <cstdint>
#include <limits>

#include "mpm/math/vec.hpp"
#include "mpm/rigid/rigid_motion.hpp"

namespace mpm {

/// What passes between two bodies in the coming step.
template <int D>
struct ActingBetween {
  int a = 0, b = 0;                                  // a < b
  Vec<double, D> on_first = Vec<double, D>::zero();  // [N]
  double rub_work = 0.0;                             // taken by friction in the step before [J]
  // Of the springs the normal force on the first, the sum of the sizes, and of places times these.
  Vec<double, D> push = Vec<double, D>::zero(), middle = Vec<double, D>::zero();  // [N]; [N m]
  double size = 0.0, stiffness = 0.0;                                             // [N]; [N/m]
  double left =
      1.0;  // of the normal force, what the bodies feel: less as they part (restitution.hpp)
  // Of the deepest overlap: it, the unit vector from a to b, and where.
  double overlap = -std::numeric_limits<double>::infinity();
  Vec<double, D> normal = Vec<double, D>::zero(), place = Vec<double, D>::zero();
};

/// A force, with its moment about the origin.
struct Wrench {
  Vector3 force = Vector3::zero(), moment = Vector3::zero();  // [N]; [N m]

  void add(const Vector3& more, const Vector3& place) {
    force += more;
    moment += cross(place, more);
  }
  Wrench& operator+=(const Wrench& other) {
    force += other.force;
    moment += other.moment;
    return *this;
  }
  friend Wrench operator+(Wrench x, const Wrench& y) { return x += y; }
  Vector3 moment_about(const Vector3& centre) const { return moment - cross(centre, force); }
};

/// What acts on a body as a whole in the coming step: on one that does not deform all of it, on
/// others what takes the energy of restitution.
struct ActingOnBody {
  int body = 0;
  Wrench push, rub, restitution;  // by springs, by friction, by what takes energy

  Wrench all() const { return push + rub + restitution; }
};

/// The two by one part, with its place in the order of all; behind all parts by its bonds.
template <int D>
struct BetweenByPart {
  std::uint64_t place = 0, entry = 0;  // `entry`: of those of a rank
  ActingBetween<D> pair;
};
struct OnBodyByPart {
  std::uint64_t place = 0;
  ActingOnBody on;
};

}  // namespace mpm
