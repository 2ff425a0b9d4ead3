#pragma once
// What the parts of a block's way through its material share: groups of lanes and the motion.
#include "mpm/materials/material_block.hpp"
#include "mpm/materials/material_view.hpp"

namespace mpm {

/// The columns that a material works on, found once for a block; null if absent. Those of a device
/// are filled in by its host.
template <int D>
struct BlockColumns {
  static constexpr int parts = Sym<double, D>::size;
  std::size_t stride = 0;
  const double* mass = nullptr;
  double* volume = nullptr;
  const Storage* velocity[D] = {};
  Storage* stress[parts] = {};
  double *state = nullptr, *energy = nullptr, *recoverable = nullptr, *viscosity_pressure = nullptr,
         *failed = nullptr, *failure_state = nullptr;
  const double *growth_limit = nullptr, *heat_owed = nullptr;
  double* damping_stress[parts] = {};

  BlockColumns() = default;
  BlockColumns(Columns& columns, const MaterialColumns& at) : stride(columns.stride()) {
    const auto optional = [&](int c) { return c >= 0 ? columns.component(c) : nullptr; };
    mass = columns.component(at.mass);
    volume = columns.component(at.volume);
    for (int a = 0; a < D; ++a) velocity[a] = columns.rounded(at.velocity + a);
    for (int c = 0; c < parts; ++c) stress[c] = columns.rounded(at.stress + c);
    state = optional(at.state);
    energy = optional(at.energy);
    recoverable = optional(at.recoverable);
    viscosity_pressure = optional(at.viscosity_pressure);
    failed = optional(at.failed);
    failure_state = optional(at.failure_state);
    growth_limit = optional(at.growth_limit);
    heat_owed = optional(at.heat_owed);
    if (at.damping_stress >= 0)
      for (int c = 0; c < parts; ++c) damping_stress[c] = columns.component(at.damping_stress + c);
  }
};

/// One group of lanes of a block: reads and writes columns and the block's own values.
template <class T, int D>
struct Group {
  static constexpr int W = lanes_of<T>;
  std::size_t at;  // in the block
  LaneRows<W> rows;

  template <int N>
  MPM_HD Group(const MaterialBlock<D, N>& block, std::size_t k)
      : at(k), rows(block.row + k, block.count - k) {}

  template <class Number>
  MPM_HD T read(const Number* column) const {
    return load(column, rows);
  }
  template <class Number>
  MPM_HD void write(Number* column, T value) const {
    store(column, rows, value);
  }
  MPM_HD T get(const double* values) const { return load_lanes<T>(values + at); }
  MPM_HD void put(double* values, T value) const { store_lanes(values + at, value); }
  MPM_HD Truth<T> valid() const { return lanes_before<T>(rows.count); }

  /// A state whose first component is the column `first`.
  template <class State>
  MPM_HD State read_state(const double* first, std::size_t stride) const {
    T flat[state_size<State, T> + 1];
    for (int k = 0; k < state_size<State, T>; ++k) flat[k] = read(first + k * stride);
    return unpack<State>(flat);
  }
  template <class State>
  MPM_HD void write_state(double* first, std::size_t stride, const State& state) const {
    T flat[state_size<State, T> + 1];
    pack(state, flat);
    for (int k = 0; k < state_size<State, T>; ++k) write(first + k * stride, flat[k]);
  }
  MPM_HD Sym<T, D> read_stress(const BlockColumns<D>& columns) const {
    Sym<T, D> stress;
    for (int c = 0; c < Sym<T, D>::size; ++c) stress.c[c] = read(columns.stress[c]);
    return stress;
  }
  template <int N>
  MPM_HD Sym<T, D> get_stress(const MaterialBlock<D, N>& block) const {
    Sym<T, D> stress;
    for (int c = 0; c < Sym<T, D>::size; ++c) stress.c[c] = get(block.stress[c]);
    return stress;
  }
  template <int N>
  MPM_HD void put_stress(MaterialBlock<D, N>& block, const Sym<T, D>& stress) const {
    for (int c = 0; c < Sym<T, D>::size; ++c) put(block.stress[c], stress.c[c]);
  }
};

/// The parts of the way are marked `flatten`: called, not inlined, the models' tensors would go
/// through memory, which costs half as much again as the whole of linear elasticity.
template <class T, int D, int N, class F>
MPM_HD void for_each_group(const MaterialBlock<D, N>& block, F&& f) {
  // Places in a block of one are constants, else it would not stay in registers.
  if constexpr (N == 1)
    f(Group<T, D>(block, 0));
  else
    for (std::size_t k = 0; k < block.count; k += lanes_of<T>) f(Group<T, D>(block, k));
}

/// The wave speed that takes the place of c in the time step where waves are damped by a viscosity
/// of Q times density and cell size: Q + sqrt(Q^2 + c^2), the exact limit of central differences
/// (Belytschko, Liu & Moran 2000, eq. 6.2.25, with the damping ratio Q / c).
template <class T>
MPM_HD T damped_speed(T c, T Q) {
  return Q + sqrt(Q * Q + c * c);
}

/// The same with damping in proportion to the stiffness, a viscosity of beta times the modulus rho
/// c^2 of the start; `c` may have others in it already. By the specific volume [m^3/kg].
template <class T>
MPM_HD T speed_with_damping(const MaterialView& material, T c, T specific, T cell_size) {
  const StiffnessDamping& damping = material.damping;
  const T Q = T(damping.beta * damping.pressure) / cell_size * specific;
  // Q' + sqrt(Q'^2 + c^2) grows by 2 per Q' at most: beside another viscosity a bound.
  if (material.viscosity.active() || material.damps) return c + T(2.0) * Q;
  return damped_speed(c, Q);
}

/// What a step did to the volume of a group.
template <class T>
struct VolumeChange {
  T mass, before, after;  // volumes [m^3]
  T dilation;             // trace of the velocity gradient x time step
  T per_volume;           // 1 / initial volume
  T J;                    // after / initial volume; of a particle at rest 1 to the bit

  MPM_HD VolumeChange(T mass_, T before_, T after_, T dilation_, double density)
      : mass(mass_),
        before(before_),
        after(after_),
        dilation(dilation_),
        per_volume(T(density) / mass_),
        J(after_ * T(density) / mass_) {}

  MPM_HD T J_before() const { return before * per_volume; }

  /// Work of a mean stress on the change of volume [J].
  MPM_HD T work(T mean_stress) const { return mean_stress * (after - before); }

  /// How fast a cell closes [m/s], negative in compression, else 0.
  MPM_HD T closing(const StressSettings& settings) const {
    return min(dilation, T(0.0)) * T(settings.cell_size / settings.time_step);
  }
  /// The artificial viscosity over density and cell size, for a speed of sound c [m/s], its
  /// pressure, and that pressure's work on the volume.
  MPM_HD T viscous_speed(const StressSettings& settings, T c) const {
    const T rate = closing(settings);
    return select(rate < T(0.0),
                  T(settings.viscosity.linear) * c - T(settings.viscosity.quadratic) * rate,
                  T(0.0));
  }
  MPM_HD T viscous_pressure(const StressSettings& settings, T viscous_speed) const {
    // q = rho (C2 h^2 e^2 - C1 h c e) = -rho (h e) (C1 c - C2 h e), h e = closing (materials.md).
    return T(-1.0) * mass / after * closing(settings) * viscous_speed;
  }
  MPM_HD T viscous_work(T pressure) const { return -after * pressure * dilation; }
};

/// Work over a step [J]: of the deviator on the material, mean of old and new stress, and of the
/// stress that the nodal forces use on the gradient as it is.
template <class T>
struct StressWork {
  T deviatoric, force;
};

/// The velocity gradient x time step of a group.
template <class T, int D, int N>
MPM_HD Mat<T, D> gradient_of(const Group<T, D>& group, const MaterialBlock<D, N>& block) {
  const auto valid = group.valid();
  Mat<T, D> gradient;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      // Behind its last particle the block's arrays may hold anything: an empty lane, which repeats
      // a particle, gets no motion.
      gradient[i][j] = select(valid, group.get(block.gradient[i][j]), T(0.0));
  return gradient;
}

/// The motion of a group over the step, and the volumes and mass that go with it.
template <class T, int D>
struct StepKinematics {
  StrainIncrement<T, D> motion;
  Sym<T, D> given;   // symmetric part of L dt as the nodes gave it
  Sym<T, D> strain;  // of the step, referred to its middle
  VolumeChange<T> volume_change;

  template <int N>
  MPM_HD StepKinematics(const Group<T, D>& group, const MaterialBlock<D, N>& block,
                        const BlockColumns<D>& columns, double density,
                        const StressSettings& settings)
      : StepKinematics(group, gradient_of(group, block), columns, density, settings) {}

  /// The material feels the strain of the middle of the step; the mean stress works on the change
  /// of volume as it is, from which the trace of the strain differs by the third order.
  MPM_HD StressWork<T> work(const StressSettings& settings, const Sym<T, D>& before,
                            const Sym<T, D>& after) const {
    const Sym<T, D> both = before + after;
    const T volume = T(0.5) * (volume_change.before + volume_change.after);
    // dev(s) : dev(e) = s : e - tr(s) tr(e) / 3, of the mean of both stresses.
    const T deviatoric =
        T(0.5) * volume * (inner(both, strain) - T(1.0 / 3.0) * trace(both) * trace(strain));
    return {deviatoric, settings.forces_follow ? volume_change.after * inner(after, given)
                                               : volume_change.before * inner(before, given)};
  }

 private:
  MPM_HD StepKinematics(const Group<T, D>& group, const Mat<T, D>& gradient,
                        const BlockColumns<D>& columns, double density,
                        const StressSettings& settings)
      : motion{settings.forces_follow ? seen_from_start(gradient) : gradient, T(1.0),
               settings.time_step, settings.time, settings.cell_size},
        given(symmetric_part(gradient)),
        strain(symmetric_part(mid_step(motion.gradient))),
        volume_change(volume_change_of(motion.gradient, group.read(columns.mass),
                                       group.read(columns.volume), density)) {
    // A volume that the grid has no room for does not grow, and is never cut.
    if (columns.growth_limit)
      volume_change = {
          volume_change.mass, volume_change.before,
          min(volume_change.after, max(volume_change.before, group.read(columns.growth_limit))),
          volume_change.dilation, density};
    volume_change.dilation = trace(given);
    motion.J = volume_change.J;
  }
  MPM_HD static VolumeChange<T> volume_change_of(const Mat<T, D>& gradient, T mass, T volume,
                                                 double density) {
    Mat<T, D> f = gradient;
    T dilation(0.0);
    for (int i = 0; i < D; ++i) {
      dilation += gradient[i][i];
      f[i][i] = gradient[i][i] + T(1.0);
    }
    // det(1 + g) and not 1 + tr(g): exact for any gradient, so that volume does not drift over a
    // cycle.
    return {mass, volume, volume * determinant(f), dilation, density};
  }
};

}  // namespace mpm
