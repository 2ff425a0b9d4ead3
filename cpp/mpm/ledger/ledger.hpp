#pragma once
// Where the energy and the momentum go. Every term is accumulated from its own sums:
//   kinetic + internal + plastic + viscous + friction + restitution + contact + springs + absorbed
//   + damped + eroded + fracture + left + bounded + numerical - external = start + residual.
//
// Derivation: a particle's velocity changes by the interpolated increments
// dv_p = sum N_ip f_i dt / m_i, eq. (17), so
//   change of kinetic = dt sum_i f_i . v_i + 1/2 sum_p m_p dv_p^2    (v_i mapped from the
//   particles),
// while the stress does the work sum_p V_p sigma_p : d eps_p. What does not cancel is named:
//
// - mapping: the stress works on the strain of another velocity field than the nodal forces do. USF
//   strains with v_i. MUSL and USL strain with velocities at the end of the step, on which the
//   forces would do sum_p m_p dv_p^2 more work than on v_i (gravity's part left out), so that much
//   is set against it.
// - time: first-order integration, 1/2 m dv^2, and the mean stress against that which gave the
// forces; and what rigid bodies' increments have beyond a rigid motion.
// - contact: normal contact that does not exactly conserve energy, with dv from eqs. (11)-(15)
//   alone; what springs hold after the step is no loss (springs). Walls that touch count in
//   friction, contact and springs, with the work of their forces in the middle of the step.
// - restitution: what is taken of bodies as wholes as they part (surfaces/restitution.cpp).
//
// A body whose motion is prescribed gets the work that this takes: the change of its kinetic energy
// and what contact takes from it, at the mean velocity of the step. Gravity does not act on it.
// The work of gravity, of loads on surfaces, of body forces, of walls which absorb waves (their
// loss is the term absorbed) and of damping of motions (damped) is taken with the velocity in the
// middle of the step, so that their part of 1/2 m dv^2 is no error.
//
// Damping of materials in proportion to their stiffness does work by a stress of its own, which the
// nodal forces use beside the other; what it takes is a part of damped.
//
// Eroded particles take their kinetic and recoverable energy at the start of a step to the term
// eroded, and their momentum out of the sum; the dissipated energies stay where they are. Particles
// that leave the region that is kept take theirs to the term left.
//
// What a particle has stored once it has failed and bears no stress goes to the term fracture, of
// materials without an equation of state.
//
// The bounds of an equation of state (materials/material.hpp, EosBounds) take the work of tension
// at its limit, and give what an energy below that of absolute zero lacks: the term bounded.
//
// A positive numerical term is energy lost, a negative one energy made. The residual tests that
// particles and nodes exchange exactly the same work; internal, viscous and friction enter
// numerical with the opposite sign, so their own values are tested elsewhere: internal and viscous
// against closed forms (tests/laws, test_viscosity.py), friction against the work that the pairs of
// bodies count (tests/verification, oblique impact).
#include <array>
#include <cmath>

#include "mpm/contact/contact.hpp"
#include "mpm/ledger/patch_sums.hpp"
#include "mpm/particles/cell_lists.hpp"

namespace mpm {

/// In the springs of contact between surfaces, of normal forces and of friction [J].
struct StoredInSurfaces {
  double push = 0.0, rub = 0.0;
};

struct Ledger {
  double kinetic = 0.0, internal = 0.0, plastic = 0.0, viscous = 0.0, friction = 0.0,
         restitution = 0.0, contact = 0.0, springs = 0.0, external = 0.0, absorbed = 0.0,
         damped = 0.0, eroded = 0.0, fracture = 0.0, left = 0.0, bounded = 0.0, mapping = 0.0,
         time_integration = 0.0;  // [J]
  double damped_stiffness = 0.0;  // the part of damped that damping of materials has taken [J]
  double unbalanced = 0.0;        // forces out of balance over those applied, of a run that settles
  double energy_floor = 0.0;      // the part of bounded that the least energy has given, <= 0 [J]
  double averaging = 0.0;         // the part of mapping that averaging volumes has [J]
  double transferred = 0.0;       // kinetic energy that transfers other than FLIP have taken [J]
  double load_work = 0.0;         // the part of external that loads and body forces have done [J]
  double gone_recoverable = 0.0;  // the part of eroded and left that was internal [J]
  double start = 0.0;             // kinetic and internal energy at the start [J]
  double largest = 0.0;           // largest energy brought in so far [J]
  std::array<double, 3> momentum{};  // [kg m/s]
  double motion_work = 0.0;          // the part of external that prescribed motions have done [J]
  std::array<double, 3> motion_impulse{};  // that they have given [N s]
  double kept_ahead = 0.0;                 // see PatchSums; of the last step, a part of kinetic [J]
  StoredInSurfaces in_surfaces;            // of springs [J]
  double prescribed_kinetic = 0.0;         // of the bodies with prescribed motion [J]
  std::array<double, 3> prescribed_momentum{};  // [kg m/s]
  AngularLedger angular;

  double numerical() const { return mapping + time_integration + transferred; }
  double residual() const {
    return kinetic + internal + plastic + viscous + friction + restitution + contact + springs +
           absorbed + damped + eroded + fracture + left + bounded + numerical() - external - start;
  }
  /// Energy made by numerics, as a fraction of the largest energy brought in; 0 while there is
  /// none. What transfers take does not hide what others make, and what they make on balance
  /// counts.
  double growth() const { return largest > 0.0 ? std::max(0.0, made()) / largest : 0.0; }
  /// Energy made by numerics so far, lost if negative; that which an energy below absolute zero was
  /// given is made as well [J].
  double made() const {
    return -std::min(mapping + time_integration, numerical()) - contact - energy_floor;
  }

  /// Velocities have been set anew between two steps.
  /// `ahead`: the part of it that nodes in bodies have not (PatchSums::kept_ahead).
  void set_kinetic(double now, double ahead = 0.0) {
    time_integration += kept_ahead - ahead;
    kept_ahead = ahead;
    kinetic = now;
  }

  /// Count the bodies with prescribed motion at the start.
  template <int D>
  void start_prescribed(const std::vector<Body<D>>& bodies, const std::vector<Patch<D>>& patches,
                        const std::vector<ParticlePool<D>>& pools, Comm& comm) {
    std::array<ExactSum, 1 + D> sums;
    for (const Patch<D>& patch : patches) {
      if (!bodies[static_cast<std::size_t>(patch.body)].is_prescribed()) continue;
      const ParticlePool<D>& pool = pools[pool_number(bodies, patch.body)];
      for (const std::uint32_t row : pool.rows(patch))
        for (std::size_t a = 0; a < D; ++a) {
          const double v = pool.v(static_cast<int>(a))[row], m = pool.mass()[row];
          sums[0].add(0.5 * m * v * v);
          sums[1 + a].add(m * v);
        }
    }
    all_sum(comm, sums);
    prescribed_kinetic = sums[0].value();
    for (std::size_t a = 0; a < D; ++a) prescribed_momentum[a] = sums[1 + a].value();
  }

  /// What prescribed motions have done in a step; returns their work [J].
  template <int D>
  double add_prescribed(const PatchSums<D>& s) {
    const double motion = s.prescribed.kinetic - prescribed_kinetic - s.prescribed.work;
    prescribed_kinetic = s.prescribed.kinetic;
    motion_work += motion;
    for (std::size_t a = 0; a < D; ++a) {
      motion_impulse[a] +=
          s.prescribed.momentum[a] - prescribed_momentum[a] - s.prescribed.impulse[a];
      prescribed_momentum[a] = s.prescribed.momentum[a];
    }
    return motion;
  }

  /// Take over the sums of a step; `forces_follow` if the stress was updated before the forces
  /// (USF), `affine` if the transfer is.
  template <int D>
  void add(const std::vector<PatchSums<D>>& patches, const ContactSums& contacts,
           const StoredInSurfaces& now, const RemovedTotal& by_erosion,
           const RemovedTotal& out_of_region, bool forces_follow, bool affine, Comm& comm) {
    const PatchSums<D> s = total_of(patches, comm);
    const double motion = add_prescribed(s);
    const double gone = by_erosion.recoverable + out_of_region.recoverable;
    internal -= gone - gone_recoverable;
    gone_recoverable = gone;
    eroded = by_erosion.kinetic + by_erosion.recoverable;
    left = out_of_region.kinetic + out_of_region.recoverable;
    unbalanced = s.applied > 0.0 ? s.unbalanced / s.applied : 0.0;
    kinetic = s.kinetic - s.carried + s.kept_ahead;
    time_integration -= s.kept_ahead - kept_ahead;
    kept_ahead = s.kept_ahead;
    const double pushed = in_surfaces.push - now.push - s.surface_push,
                 rubbed = in_surfaces.rub - now.rub - s.surface_rub;
    for (std::size_t a = 0; a < D; ++a) momentum[a] = s.momentum[a];
    internal += s.stress.internal - s.stress.fracture + s.returned;
    fracture += s.stress.fracture;
    plastic += s.stress.plastic;
    viscous += s.stress.viscous;
    damped_stiffness += s.stress.damped;
    bounded += s.stress.bounded;
    energy_floor += s.stress.energy_floor;
    friction += contacts.friction - (s.wall_friction.first + s.wall_friction.second) + rubbed;
    restitution -= s.restitution;
    const double in_nodes = springs - in_surfaces.push - in_surfaces.rub,
                 stored = contacts.stored + s.wall_stored;
    contact +=
        contacts.energy - (s.wall_push.first + s.wall_push.second) - (stored - in_nodes) + pushed;
    springs = stored + now.push + now.rub;
    in_surfaces = now;
    load_work += s.load_first + s.load_second;
    external += s.gravity_first + s.gravity_second + s.load_first + s.load_second + motion;
    absorbed -= s.dashpot_first + s.dashpot_second;
    damped += s.stress.damped - (s.damping_first + s.damping_second);
    const double second = s.second_order - s.gravity_second - s.load_second - s.dashpot_second -
                          s.wall_push.second - s.wall_friction.second - s.damping_second;
    const double at_end = (forces_follow ? 0.0 : 2.0 * second) + s.kept_shift;
    mapping -= s.force_work - contacts.force_work + s.stress.force_power + at_end;
    averaging -= s.stress.averaging;
    transferred += s.transferred + s.carried + s.unseen - s.returned;
    // Of affine transfers, the work of all forces at the velocities that were mapped, before
    // (6)-(7), and the second order: what the energies of free particles should have changed by.
    if (affine)
      transferred += s.force_work + s.gravity_first + s.load_first + s.dashpot_first +
                     s.wall_push.first + s.wall_friction.first + s.damping_first + s.second_order +
                     s.surface_push + s.surface_rub + s.restitution - s.prescribed.work -
                     (contacts.energy + contacts.friction_first + contacts.force_work);
    time_integration += s.made_rigid;
    time_integration -= s.stress.internal + s.stress.plastic + s.stress.viscous + s.stress.damped +
                        s.stress.bounded - s.stress.force_power + second + s.unseen +
                        contacts.friction - contacts.friction_first - at_end;
    largest = std::max({largest, std::abs(start), std::abs(external)});
    angular.add(patches, comm);
    angular.removed = by_erosion.angular_momentum + out_of_region.angular_momentum;
  }
};

}  // namespace mpm
