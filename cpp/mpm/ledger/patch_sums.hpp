#pragma once
// What the ledger needs from one patch in one step.
#include <array>
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/ledger/angular_ledger.hpp"
#include "mpm/ledger/work.hpp"
#include "mpm/materials/material_block.hpp"
#include "mpm/math/exact_sum.hpp"

namespace mpm {

/// Of a patch whose body's motion is prescribed.
template <int D>
struct PrescribedSums {
  double kinetic = 0.0;     // after the step [J]
  double momentum[D] = {};  // after the step [kg m/s]
  double work = 0.0;        // of the contact forces on it, at the mean velocity of the step [J]
  double impulse[D] = {};   // of the contact forces on it [N s]
};

/// What the ledger needs from one patch in one step. Every patch has its own, so that no sum
/// depends on the number of threads.
template <int D>
struct PatchSums {
  StressSums stress;
  double kinetic = 0.0;       // of the particles after the step [J]
  double second_order = 0.0;  // half sum of m_p (sum of dv_i N_ip)^2 [J]
  // Of nodes in bodies: what stress has lost of kinetic energy less what it has strained by, as the
  // ones take forces about the start of the step and the other their work along it [J].
  double kept_shift = 0.0;
  // Of nodes in bodies: by how much more kinetic energy they have at the end of the step than in
  // its middle, of which their velocities are [J].
  double kept_ahead = 0.0;
  double transferred = 0.0;  // kinetic energy that the transfer has taken against FLIP; of affine
                             // transfers all that particles lack against the start of the step [J]
  double carried = 0.0;      // kinetic energy that affine parts lose as they are carried along [J]
  double returned = 0.0;     // of what the transfer took, what a gas has got back as heat [J]
  double unseen = 0.0;       // of gases, what the nodes' increments hold beyond second_order [J]
  double momentum[D] = {};   // of the particles after the step [kg m/s]
  double force_work =
      0.0;  // time step x sum over nodes of internal and contact force . velocity [J]
  double made_rigid =
      0.0;  // kinetic energy that rigid bodies' increments had beyond a rigid motion [J]
  double gravity_first = 0.0;   // time step x sum over nodes of gravity . velocity [J]
  double gravity_second = 0.0;  // the part of second_order that is the work of gravity [J]
  PrescribedSums<D> prescribed;
  double load_first = 0.0, load_second = 0.0;        // the same of loads, body forces too [J]
  double dashpot_first = 0.0, dashpot_second = 0.0;  // the same of walls that absorb [J]
  // The same of walls that touch, and of surfaces that particles press: normal forces, friction
  // [J].
  Work wall_push, wall_friction;
  double wall_stored = 0.0;  // in their springs, after the step [J]
  // Work of contact between surfaces: of springs, of friction, of what takes energy as bodies part
  // [J].
  double surface_push = 0.0, surface_rub = 0.0, restitution = 0.0;
  double damping_first = 0.0, damping_second = 0.0;  // the same of damping of motions [J]
  // Sizes of the forces out of balance at the nodes and of those applied, while a run settles [N].
  double unbalanced = 0.0, applied = 0.0;
  AngularImpulses angular;  // in the step; summed by AngularLedger

  /// f(number) for all that are summed over the patches, in one order.
  template <class F>
  void for_each(F&& f) {
    for (double* const x : {&stress.internal,
                            &stress.plastic,
                            &stress.viscous,
                            &stress.damped,
                            &stress.bounded,
                            &stress.energy_floor,
                            &stress.fracture,
                            &stress.force_power,
                            &stress.averaging,
                            &kinetic,
                            &second_order,
                            &kept_shift,
                            &kept_ahead,
                            &transferred,
                            &carried,
                            &returned,
                            &unseen,
                            &force_work,
                            &made_rigid,
                            &gravity_first,
                            &gravity_second,
                            &prescribed.kinetic,
                            &prescribed.work,
                            &load_first,
                            &load_second,
                            &dashpot_first,
                            &dashpot_second,
                            &damping_first,
                            &damping_second,
                            &unbalanced,
                            &applied,
                            &wall_push.first,
                            &wall_push.second,
                            &wall_friction.first,
                            &wall_friction.second,
                            &wall_stored,
                            &surface_push,
                            &surface_rub,
                            &restitution})
      f(*x);
    for (int a = 0; a < D; ++a) {
      f(momentum[a]);
      f(prescribed.momentum[a]);
      f(prescribed.impulse[a]);
    }
  }
  static constexpr std::size_t numbers = 39 + 3 * D;  // of for_each
};

/// The sums over all patches of all ranks, which depend on no order.
template <int D>
PatchSums<D> total_of(const std::vector<PatchSums<D>>& patches, Comm& comm) {
  std::array<ExactSum, PatchSums<D>::numbers> sums;
  for (PatchSums<D> patch : patches) {
    std::size_t k = 0;
    patch.for_each([&](double x) { sums[k++].add(x); });
  }
  all_sum(comm, sums);
  PatchSums<D> total;
  std::size_t k = 0;
  total.for_each([&](double& x) { x = sums[k++].value(); });
  return total;
}

/// Sums over the nodes that a patch owns, with v before the step: A + B and G of the ledger and
/// twice S_g, all but for the time step.
struct NodeWork {
  double work = 0.0, gravity_first = 0.0, gravity_second = 0.0;
};

}  // namespace mpm
