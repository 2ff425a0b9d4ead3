#pragma once
// What turns the bodies. About the origin, with M the angular momentum of all that takes part,
//   M + removed + numerical = that of the start + gravity + loads + walls + damping + motion.
//
// All but the last are sums of x_i x J_i over the nodes, J_i the impulse of a step at the node with
// the place x_i. Those of the stress are zero, as the stress is symmetric and sum x_i grad N_ip =
// 1; so are those of contact, which gives both bodies opposite ones at the same node. Walls push by
// what keeps a node from moving, and fold what lies beyond them (walls/reactions.hpp). A body whose
// motion is prescribed gets the torque that this takes: the change of its angular momentum, less
// what contact gives it. What is left is numerical: FLIP takes increments at the particles, not at
// the nodes, and particles move by another velocity than they have.
#include <array>
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/rigid/rigid_motion.hpp"

namespace mpm {

/// Angular impulses about the origin [N m s], along x and y 0 in 2D.
struct AngularImpulses {
  Vector3 gravity = Vector3::zero();
  Vector3 loads = Vector3::zero();          // and body forces
  Vector3 walls = Vector3::zero();          // by forces
  Vector3 damping = Vector3::zero();        // of motions
  Vector3 mapped = Vector3::zero();         // of walls, by what particles take of mapped velocities
  Vector3 on_prescribed = Vector3::zero();  // of contact, on bodies with prescribed motion

  static constexpr std::array<Vector3 AngularImpulses::*, 6> all();
};
constexpr std::array<Vector3 AngularImpulses::*, 6> AngularImpulses::all() {
  using A = AngularImpulses;
  return {&A::gravity, &A::loads, &A::walls, &A::damping, &A::mapped, &A::on_prescribed};
}

struct AngularLedger {
  AngularImpulses impulses;           // so far [N m s]
  Vector3 removed = Vector3::zero();  // taken by particles that take no part any more
  Vector3 start = Vector3::zero();    // of all at the start, with what was set from outside later
  Vector3 prescribed_start = Vector3::zero();  // of the bodies with prescribed motion

  /// Take over the impulses of a step, of the patches' sums.
  template <class Sums>
  void add(const std::vector<Sums>& patches, Comm& comm) {
    constexpr auto parts = AngularImpulses::all();
    // No order of patches matters (decision 0038). Most have nothing of most.
    std::array<ExactSum, 3 * parts.size()> sums;
    for (const Sums& patch : patches)
      for (std::size_t k = 0; k < parts.size(); ++k)
        for (std::size_t a = 0; a < 3; ++a)
          if (const double x = (patch.angular.*parts[k]).c[a]; x != 0.0) sums[3 * k + a].add(x);
    all_sum(comm, sums);
    for (std::size_t k = 0; k < parts.size(); ++k)
      for (std::size_t a = 0; a < 3; ++a) (impulses.*parts[k]).c[a] += sums[3 * k + a].value();
  }
};

/// The terms of the balance [N m s].
struct AngularBalance {
  Vector3 momentum, gravity, loads, walls, damping, motion, removed, numerical;
};

/// `momentum` is that of all that takes part, `prescribed` that of bodies with prescribed motion.
inline AngularBalance balance_of(const AngularLedger& ledger, const Vector3& momentum,
                                 const Vector3& prescribed) {
  const AngularImpulses& given = ledger.impulses;
  AngularBalance r;
  r.momentum = momentum;
  r.gravity = given.gravity;
  r.loads = given.loads;
  r.walls = given.walls + given.mapped;
  r.damping = given.damping;
  r.motion = prescribed - ledger.prescribed_start - given.on_prescribed;
  r.removed = ledger.removed;
  r.numerical =
      ledger.start + r.gravity + r.loads + r.walls + r.damping + r.motion - r.removed - momentum;
  return r;
}

}  // namespace mpm
