#pragma once
// The first part of a block's way through its material: stress and state by the strength model.
#include "mpm/materials/stress_writer.hpp"

namespace mpm {

/// In the body laws by rates are of Kirchhoff's stress J sigma, but for its mean, which is a
/// function of J. Those of Cauchy's stress have no potential, not for small strains about a stress
/// that is there already either: vibrations about it, which nothing damps there, would take energy
/// from it for ever (decision 86).
template <class Model>
MPM_HD bool of_kirchhoff([[maybe_unused]] const StressSettings& settings) {
#if defined(__CUDA_ARCH__)
  return false;  // A device knows no bodies on nodes of their own.
#else
  constexpr bool by_rates = requires { requires Model::by_rates; };
  return by_rates && settings.squeezed != nullptr;
#endif
}

/// A stress whose deviator is so many times as large.
template <class T, int D>
MPM_HD Sym<T, D> with_deviator(const Sym<T, D>& stress, T factor) {
  return factor * stress + Sym<T, D>::isotropic((T(1.0) - factor) * T(1.0 / 3.0) * trace(stress));
}

/// Stress and state of the end of the step by a model; returns what it dissipates.
template <class Model, class T, int D>
MPM_HD T update_by(const Model& model, const StressSettings& settings,
                   const StepKinematics<T, D>& kinematics, Sym<T, D>& stress,
                   typename Model::template State<T, D>& state) {
  const bool scaled = of_kirchhoff<Model>(settings);
  if (scaled) stress = with_deviator(stress, kinematics.volume_change.J_before());
  const T dissipated = model.update(kinematics.motion, stress, state);
  if (scaled) stress = with_deviator(stress, T(1.0) / kinematics.motion.J);
  return dissipated;
}

/// By what volume waves are faster: those of shape are no slower for a smaller one.
template <class Model, class T>
MPM_HD T volume_of_waves(const StressSettings& settings, T J) {
  return of_kirchhoff<Model>(settings) ? max(T(1.0), J) : J;
}

/// The model is a copy, which no store to a column can change. Which part is the last is decided
/// for the block, not in lanes: the last part of the way writes, the others leave their values in
/// the block, which stays in the first-level cache (decision 0009).
template <class T, int D, int N, class Model>
MPM_FLATTEN MPM_HD void apply_strength(const Model model, const MaterialView& material,
                                       const BlockColumns<D>& columns,
                                       const StressSettings& settings, MaterialBlock<D, N>& block,
                                       StressWriter<T, D>& writer) {
  using State = typename Model::template State<T, D>;
  const bool viscosity = settings.viscosity.active(), judged = material.judged;
  const bool last = !material.has_eos && !judged;
  for_each_group<T>(block, [&](const Group<T, D>& group) {
    const StepKinematics<T, D> kinematics(group, block, columns, material.density, settings);
    const StrainIncrement<T, D>& motion = kinematics.motion;
    const Sym<T, D> stress_before = group.read_stress(columns);
    // The old stress is read once, for the work takes the mean of both.
    Sym<T, D> stress = stress_before;
    State state = group.template read_state<State>(columns.state, columns.stride);
    const State before = state;
    const T dissipated = update_by(model, settings, kinematics, stress, state);
    group.write_state(columns.state, columns.stride, state);
    const T J = volume_of_waves<Model>(settings, motion.J);
    T speed(0.0), q(0.0);
    // By the model where it can be known: functions that a model does not have are not asked for.
    if constexpr (Model::eos != EosUse::never)
      if (material.has_eos) speed = model.other_speed_squared(state, J);
    if constexpr (Model::eos != EosUse::must)
      if (!material.has_eos) {
        speed = model.sound_speed(stress, state, J);
        if (viscosity) {
          const T damping = kinematics.volume_change.viscous_speed(settings, speed);
          q = kinematics.volume_change.viscous_pressure(settings, damping);
          speed = damped_speed(speed, damping);
        }
      }
    if (last) {
      writer.template add<false>(group, kinematics, stress_before, {stress, dissipated, speed, q});
      return;
    }
    group.put_stress(block, stress);
    group.put(block.dissipated, dissipated);
    group.put(block.speed, speed);
    group.put(block.viscous_pressure, q);
    if (material.has_eos) {
      const StressWork<T> work = kinematics.work(settings, stress_before, stress);
      group.put(block.volume, kinematics.volume_change.after);
      group.put(block.dilation, kinematics.volume_change.dilation);
      group.put(block.deviatoric_work, work.deviatoric);
      group.put(block.force_work, work.force);
      group.put(block.mean_before, T(1.0 / 3.0) * trace(stress_before));
    }
    if constexpr (Burns<Model>) group.put(block.burnt, state.burn_fraction);
    if constexpr (Damps<Model>)
      group.put(block.damping, model.damping_speed(motion.J, motion.cell_size));
    // Failure models alone ask for what follows.
    if (!judged) return;
    T strain(0.0), increment(0.0), temperature(0.0);
    if constexpr (requires { state.plastic_strain; }) {
      strain = state.plastic_strain;
      increment = strain - before.plastic_strain;
    }
    if constexpr (requires { model.homologous(state.temperature); })
      temperature = model.homologous(state.temperature);
    group.put(block.plastic_strain, strain);
    group.put(block.plastic_increment, increment);
    group.put(block.temperature, temperature);
  });
}

}  // namespace mpm
