#pragma once
// The end of a block's way through its material: store stress, volume and energy, and add up what
// the ledger and the time step need. The last part of the way calls it while all is in registers.
#include "mpm/materials/block_parts.hpp"

namespace mpm {

/// Of one group of lanes, when all parts have done their work.
template <class T, int D>
struct StressUpdate {
  Sym<T, D> stress;
  T dissipated, speed, viscous_pressure;
  T gives_up = T(0.0);  // 1: it has failed and bears no stress, so that it stores nothing
};

template <class T, int D>
class StressWriter {
 public:
  MPM_HD StressWriter(const BlockColumns<D>& columns, const StressSettings& settings,
                      const MaterialView& material)
      : columns_(columns), settings_(settings), material_(material), bounds_(material.bounds) {}

  /// `work`: with the stress at the end of the step. `mean_stress`: over the step the average of a
  /// third of the stress's trace, which works on the change of volume. `with_eos`: is there, or may
  /// there be, an equation of state, and with it an energy and its bounds?
  template <bool with_eos>
  MPM_HD void add(const Group<T, D>& group, const VolumeChange<T>& volume_change,
                  const StressWork<T>& work, T mean_stress, const StressUpdate<T, D>& after) {
    const auto valid = group.valid();
    // Written so that no number counts as negative too.
    negative_ = negative_ | (valid & !(volume_change.after > T(0.0)));

    const bool heated_elsewhere = with_eos && columns_.heat_owed != nullptr;
    T done = heated_elsewhere ? T(0.0) : work.deviatoric + volume_change.work(mean_stress);
    // Dissipation is per present volume, the ledger wants joules: the mean volume of the step.
    const T lost = T(0.5) * (volume_change.before + volume_change.after) * after.dissipated;
    T used = work.force, heat = done;
    if (settings_.viscosity.active()) {
      const T q = after.viscous_pressure, viscous_work = volume_change.viscous_work(q);
      const T q_before = group.read(columns_.viscosity_pressure);
      group.write(columns_.viscosity_pressure, q);
      if (!heated_elsewhere) viscous_ += select(valid, viscous_work, T(0.0));
      // The viscous pressure that the nodal forces use, eq. (9): of this step where they follow
      // the stress (USF), else that of the step before.
      used -=
          (settings_.forces_follow ? volume_change.after * q : volume_change.before * q_before) *
          volume_change.dilation;
      heat += viscous_work;
    }
    if (with_eos && columns_.energy && !heated_elsewhere)
      done -=
          keep_energy(group, volume_change, heat, mean_stress, T(1.0 / 3.0) * trace(after.stress));
    if (columns_.recoverable) {
      const T energy = group.read(columns_.recoverable) + (done - lost) * volume_change.per_volume;
      // With an equation of state there is heat in it.
      const T given_up = columns_.energy ? T(0.0) : after.gives_up * energy;
      fracture_ += select(valid, given_up / volume_change.per_volume, T(0.0));
      group.write(columns_.recoverable, energy - given_up);
    }
    group.write(columns_.volume, volume_change.after);
    for (int i = 0; i < Sym<T, D>::size; ++i) group.write(columns_.stress[i], after.stress.c[i]);
    internal_ += select(valid, done - lost, T(0.0));
    dissipated_ += select(valid, lost, T(0.0));
    force_power_ += select(valid, used, T(0.0));

    T speed = after.speed;
    const T squeezed = settings_.squeezed ? group.read(settings_.squeezed) : T(1.0);
    if (columns_.damping_stress[0])
      speed = speed_with_damping(material_, speed, volume_change.after / volume_change.mass,
                                 T(settings_.cell_size) / squeezed);
    speed = speed * squeezed;
    if (!settings_.squeezed) {
      Vec<T, D> v;
      for (int a = 0; a < D; ++a) v[a] = group.read(columns_.velocity[a]);
      speed += sqrt(dot(v, v));
    }
    // What flows must not change its volume by more than a wave's way in a step allows.
    if (with_eos && columns_.growth_limit)
      speed = max(speed,
                  absolute(volume_change.dilation) * T(settings_.cell_size / settings_.time_step));
    // An empty lane holds a particle that is taken elsewhere, without its motion.
    fastest_ = max(fastest_, select(valid, speed, T(0.0)));
  }
  template <bool with_eos>
  MPM_HD void add(const Group<T, D>& group, const StepKinematics<T, D>& kinematics,
                  const Sym<T, D>& before, const StressUpdate<T, D>& after) {
    add<with_eos>(group, kinematics.volume_change, kinematics.work(settings_, before, after.stress),
                  T(1.0 / 6.0) * trace(before + after.stress), after);
  }

  MPM_HD void add_to(StressSums& sums) const {
    sums.internal += sum(internal_);
    sums.plastic += sum(dissipated_);
    sums.viscous += sum(viscous_);
    sums.bounded += sum(bounded_);
    sums.energy_floor += sum(floor_);
    sums.force_power += sum(force_power_);
    sums.fracture += sum(fracture_);
    sums.fastest = max(sums.fastest, largest(fastest_));
    sums.negative_volume = sums.negative_volume || any(negative_);
  }

 private:
  /// The energy of an equation of state keeps what plastic flow and viscosity heat; the ledger's
  /// `internal` has neither, for both have columns of their own (materials.md). Gives the work that
  /// the bounds took [J]; `last`: the mean stress of the end.
  MPM_HD T keep_energy(const Group<T, D>& group, const VolumeChange<T>& volume_change, T heat,
                       T mean_stress, T last) {
    T energy = group.read(columns_.energy) + heat * volume_change.per_volume, work(0.0);
    if (bounds_.active) {
      // The mean of both is given: the one before need not be read again.
      const T first = T(2.0) * mean_stress - last;
      if (any(bounds_.limits(first) | bounds_.limits(last) | (energy < T(bounds_.lowest_energy)))) {
        const Taken taken = bound(bounds_, volume_change, first, last, energy);
        energy = taken.energy;
        work = taken.opening - taken.given;
        const auto valid = group.valid();
        bounded_ += select(valid, work, T(0.0));
        floor_ -= select(valid, taken.given, T(0.0));
      }
    }
    group.write(columns_.energy, energy);
    return work;
  }

  /// What the bounds leave of an energy [J/m^3], and the work that they take and give [J].
  struct Taken {
    T energy, opening, given;
  };
  /// Keep the energy within the bounds. `first`, `last`: mean stresses before and after. Work that
  /// tension at its limit does opens voids between fragments, in place of straining the matter: it
  /// is taken, and given back when they close. What is missing to the least energy is given.
  MPM_COLD MPM_HD static Taken bound(EosBounds bounds, VolumeChange<T> volume_change, T first,
                                     T last, T energy) {
    const T limited = T(0.5) * (select(bounds.limits(first), first, T(0.0)) +
                                select(bounds.limits(last), last, T(0.0)));
    const T opening = volume_change.work(limited);
    const T left = energy - opening * volume_change.per_volume;
    const T missing = max(T(bounds.lowest_energy) - left, T(0.0));
    return {max(left, T(bounds.lowest_energy)), opening, missing / volume_change.per_volume};
  }

  const BlockColumns<D>& columns_;
  const StressSettings& settings_;
  const MaterialView& material_;
  const EosBounds bounds_;
  T internal_ = T(0.0), dissipated_ = T(0.0), viscous_ = T(0.0), force_power_ = T(0.0),
    fracture_ = T(0.0), bounded_ = T(0.0), floor_ = T(0.0), fastest_ = T(0.0);
  Truth<T> negative_ = T(1.0) < T(0.0);
};

}  // namespace mpm
