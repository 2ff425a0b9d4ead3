#pragma once
// The motion as a whole of a body on nodes of its own. These have the spread of the shape
// functions, so that their moment of inertia I is that of the particles and D = m h^2 / 2 more.
// Angular momentum L is kept as that of the body, with I - D, and the nodes are given the spin that
// it has: I (I - D)^-1 L is theirs.
#include <algorithm>
#include <vector>

#include "mpm/rigid/rigid_motion.hpp"

namespace mpm {

struct KeptSpin {
  int body = 0;
  unsigned held = 0;                   // axes along which walls hold nodes of it, a bit each
  bool begun = false;                  // are the others known?
  Vector3 momentum = Vector3::zero();  // L about the centre, in the middle of the last step [N m s]
  Vector3 of_nodes = Vector3::zero();  // what the nodes have [N m s]
  Vector3 spin = Vector3::zero();      // [rad/s]
  Vector3 centre = Vector3::zero();    // of mass, at the start of the step [m]
  Vector3 velocity = Vector3::zero();  // of it, in the middle of the step [m/s]
  Vector3 acceleration = Vector3::zero();  // of it, at the start of the step [m/s^2]
  double mass = 0.0, excess = 0.0;         // of the body [kg]; D [kg m^2]
};

/// One that other ranks have a part of.
struct SharedBody {
  std::int32_t spin = 0;      // of all KeptSpin
  bool first = false;         // does this rank have the first of its tiles?
  std::vector<int> others{};  // ranks
};

/// The kinetic energy that nodes have more than their bodies [J].
inline double kinetic_excess(const std::vector<KeptSpin>& all) {
  double sum = 0.0;
  for (const KeptSpin& one : all) sum += 0.5 * one.excess * dot(one.spin, one.spin);
  return sum;
}

/// Of a body's centre [m/s^2], 0 along axes on which walls hold it.
inline Vector3 acceleration_of(const std::vector<KeptSpin>& all, int body) {
  const auto at = std::ranges::lower_bound(all, body, {}, &KeptSpin::body);
  return at != all.end() && at->body == body ? at->acceleration : Vector3::zero();
}

/// What the nodes of a body have more than the body, for each of their mass.
struct OfTurning {
  double kinetic = 0.0, inertia = 0.0;  // [J/kg], about each axis [m^2]
  Vector3 momentum = Vector3::zero();   // angular [m^2/s]
};
inline OfTurning of_turning(const std::vector<KeptSpin>& all, int body) {
  const auto at = std::ranges::lower_bound(all, body, {}, &KeptSpin::body);
  if (at == all.end() || at->body != body || !at->begun) return {};
  return {0.5 * at->excess * dot(at->spin, at->spin) / at->mass, at->excess / at->mass,
          (1.0 / at->mass) * (at->of_nodes - at->momentum)};
}

}  // namespace mpm
