#pragma once
// The third part: what has failed, and what failure does to the stress.
#include "mpm/materials/failure_list.hpp"
#include "mpm/materials/stress_writer.hpp"

namespace mpm {

/// By how much what has failed may be squeezed before it bears nothing; steps would get shorter by
/// as much.
constexpr double most_squeezed = 4.0;

/// A particle stays failed; of several models that it fails by, the strongest action is done.
/// `failures` is what for_each_failure() takes.
template <class T, int D, int N, class Failures>
MPM_FLATTEN MPM_HD void apply_failures(const MaterialView& material, const Failures& failures,
                                       const BlockColumns<D>& columns,
                                       const StressSettings& settings, MaterialBlock<D, N>& block,
                                       StressWriter<T, D>& writer, StressSums& sums) {
  double* state_at = columns.failure_state;
  for_each_failure(failures, [&]<class Model>(const Model& model, FailureAction done) {
    using State = typename Model::template State<T, D>;
    const T action(static_cast<double>(done));
    for_each_group<T>(block, [&](const Group<T, D>& group) {
      const StepKinematics<T, D> kinematics(group, block, columns, material.density, settings);
      const T energy = columns.energy ? group.read(columns.energy) : T(0.0);
      const Condition<T, D> condition{group.get_stress(block),
                                      kinematics.motion.gradient,
                                      group.get(block.plastic_strain),
                                      group.get(block.plastic_increment),
                                      group.get(block.temperature),
                                      energy,
                                      settings.time_step};
      State state = group.template read_state<State>(state_at, columns.stride);
      const T damage = model.damage(condition, state);
      group.write_state(state_at, columns.stride, state);
      const T failed = group.read(columns.failed);
      // The largest: actions are numbered by what they take, and a failed particle does not heal.
      group.write(columns.failed, max(failed, select(damage >= T(1.0), action, T(0.0))));
    });
    state_at += state_size<State, T> * columns.stride;
  });

  const T gone(static_cast<double>(FailureAction::erode));
  auto eroded = T(1.0) < T(0.0);
  for_each_group<T>(block, [&](const Group<T, D>& group) {
    const T failed = group.read(columns.failed);
    eroded = eroded | (group.valid() & (failed >= gone));
    const Sym<T, D> stress = group.get_stress(block);
    const T mean = T(1.0 / 3.0) * trace(stress);
    // In every step, not once: strength and equation of state have made a new stress.
    T kept = select(failed >= T(static_cast<double>(FailureAction::no_tension)), min(mean, T(0.0)),
                    mean);
    kept = select(failed >= gone, T(0.0), kept);
    const StepKinematics<T, D> kinematics(group, block, columns, material.density, settings);
    // Where nodes lie in the body they still pull at it: it bears what presses it below its volume,
    // and nothing once it is crushed.
    if (settings.squeezed)
      kept = select((failed > T(0.0)) & ((kinematics.volume_change.J >= T(1.0)) |
                                         (group.read(settings.squeezed) > T(most_squeezed))),
                    T(0.0), kept);
    const T deviator = select(failed > T(0.0), T(0.0), T(1.0));
    const Sym<T, D> left =
        Sym<T, D>::isotropic(kept) + deviator * (stress - Sym<T, D>::isotropic(mean));
    // A torn particle that gapes is loose matter: no waves run in it, and closing it costs nothing.
    const auto separated =
        (failed >= T(static_cast<double>(FailureAction::no_tension))) & (kept >= T(0.0));
    // What has failed has no deviator to flow with: the model, which begins at none in every step,
    // would let it yield again and again.
    writer.template add<true>(group, kinematics, group.read_stress(columns),
                              {left, deviator * group.get(block.dissipated),
                               select(separated, T(0.0), group.get(block.speed)),
                               select(separated, T(0.0), group.get(block.viscous_pressure)),
                               select(separated & (failed < gone), T(1.0), T(0.0))});
  });
  sums.eroded = sums.eroded || any(eroded);
}

}  // namespace mpm
