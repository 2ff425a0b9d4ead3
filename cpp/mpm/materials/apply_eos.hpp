#pragma once
// The second part: the mean stress by an equation of state, solved together with the energy.
#include "mpm/materials/stress_writer.hpp"

namespace mpm {

/// dp/drho at constant entropy [m^2/s^2], from dE = -p dV: V^2 (p B - A' - B' E) / rho0.
template <class T>
MPM_HD T sound_speed_squared(const LinearInEnergy<T>& at, T V, T energy, double density) {
  return max(V * V * (at.pressure(energy) * at.B - at.dA - at.dB * energy) * T(1.0 / density),
             T(0.0));
}

/// p (1 + B dV/2) = A + B E, E the energy of the end but for the work -p dV/2 of the new pressure.
template <class T>
MPM_HD T pressure_at_end(const LinearInEnergy<T>& line, T V, T energy, T change) {
  // Debris of many times its volume may close by more than its initial volume in one step, where
  // the energy's part of the denominator would pass zero; a shock begins below that volume, as heat
  // swells a solid by less than a fifth.
  T implicit = T(1.0) + T(0.5) * line.B * change;
  implicit = select((V > T(1.0)) | (V - change > T(1.2)), max(implicit, T(0.5)), implicit);
  return line.pressure(energy) / implicit;
}

/// Steps of Newton's method where the pressure is not linear in the energy, the same for all, so
/// that a particle's bits do not depend on those beside it. They start from the pressure of the old
/// energy: its tangent would lead to energies below zero where a shock halves the volume.
inline constexpr int energy_steps = 5;

/// E of the end but for -p dV / 2 of the new pressure: the old mean stress, tension positive, works
/// on half of the change.
template <class T>
MPM_HD T without_new_pressure(const EosBounds& bounds, T energy, T deviatoric_work, T mean_before,
                              T change) {
  energy = energy + deviatoric_work + T(0.5) * mean_before * change;
  if (bounds.active && any(bounds.limits(mean_before)))
    energy = bounds.without_voids(energy, mean_before, change);
  return energy;
}

/// The energy per initial volume grows by the work of the deviator, of the pressure (mean of old
/// and new) and of the artificial viscosity; with p = A + B E that gives p in closed form. Where p
/// is not linear in E, the same with its tangent is a step of Newton's method.
template <class T, int D, int N, class Model>
MPM_FLATTEN MPM_HD void apply_eos(const Model model, const MaterialView& material,
                                  const BlockColumns<D>& columns, const StressSettings& settings,
                                  MaterialBlock<D, N>& block, StressWriter<T, D>& writer) {
  const bool burns = material.burns, damped = material.damps;
  const bool viscosity = settings.viscosity.active(), last = !material.judged;
  const EosBounds bounds = material.bounds;
  // A gas that is heated where its particles are advanced has the heat of the middle of the step:
  // -p dV / 2 is all that it lacks.
  const bool heated_elsewhere = columns.heat_owed != nullptr;
  for_each_group<T>(block, [&](const Group<T, D>& group) {
    const VolumeChange<T> volume_change(group.read(columns.mass), group.read(columns.volume),
                                        group.get(block.volume), group.get(block.dilation),
                                        material.density);
    const Sym<T, D> strength = group.get_stress(block);
    StressWork<T> work{group.get(block.deviatoric_work), group.get(block.force_work)};
    const T V = volume_change.J, per_volume = volume_change.per_volume;
    const T change = (volume_change.after - volume_change.before) * per_volume;  // of V
    const T mean_before = group.get(block.mean_before);

    const auto line_at = [&](T energy) {
      const LinearInEnergy<T> line = line_of(model, V, energy);
      return burns ? line.burnt(group.get(block.burnt)) : line;
    };
    T energy = group.read(columns.energy);
    if (!heated_elsewhere)
      energy =
          without_new_pressure(bounds, energy, work.deviatoric * per_volume, mean_before, change);
    // The speed of sound is that at the energy before the pressure's own work: it only bounds the
    // next step and scales the viscosity.
    LinearInEnergy<T> p = line_at(energy);
    T speed = sqrt(sound_speed_squared(p, V, energy, material.density) + group.get(block.speed));
    T q(0.0), damping = damped ? group.get(block.damping) : T(0.0);
    if (viscosity) {
      const T artificial = volume_change.viscous_speed(settings, speed);
      q = volume_change.viscous_pressure(settings, artificial);
      if (!heated_elsewhere) energy += volume_change.viscous_work(q) * per_volume;
      damping += artificial;
    }
    if (viscosity || damped) speed = damped_speed(speed, damping);
    T pressure = LinearEos<Model> ? pressure_at_end(p, V, energy, change) : p.pressure(energy);
    if constexpr (!LinearEos<Model>)
      for (int k = 0; k < energy_steps; ++k) {
        p = line_at(energy - T(0.5) * pressure * change);
        pressure = pressure_at_end(p, V, energy, change);
      }
    if (bounds.active && any((pressure < T(-bounds.tension)) |
                             (energy - T(0.5) * pressure * change < T(bounds.lowest_energy))))
      pressure = bounds.held(pressure, energy, change, line_at(T(bounds.lowest_energy)));
    // The strength's own mean stress is dropped: p takes its place, s - (mean + p) 1.
    const T shift = T(1.0 / 3.0) * trace(strength) + pressure;
    const Sym<T, D> stress = strength - Sym<T, D>::isotropic(shift);
    if (last) {
      if (settings.forces_follow)
        work.force -= volume_change.after * shift * volume_change.dilation;
      writer.template add<true>(group, volume_change, work, T(0.5) * (mean_before - pressure),
                                {stress, group.get(block.dissipated), speed, q});
      return;
    }
    group.put_stress(block, stress);
    group.put(block.speed, speed);
    group.put(block.viscous_pressure, q);
  });
}

}  // namespace mpm
