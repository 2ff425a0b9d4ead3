#pragma once
// The loop over a block of particles in which a strength model is called on SIMD lanes: one
// indirect call per block.
#include <cstring>

#include "mpm/fields/columns.hpp"
#include "mpm/fields/lanes.hpp"
#include "mpm/materials/material.hpp"

namespace mpm {

/// Velocity gradients x time step of up to `capacity` particles, gathered from the cells of a
/// patch.
template <int D>
struct GradientBlock {
  static constexpr int capacity = 128;
  static constexpr int room =
      capacity + native_lanes;  // a register may be stored past the last particle
  std::uint32_t row[room];
  double gradient[D][D][room];
  std::size_t count = 0;
};

/// Where a body keeps what a strength model reads and writes: first components in its columns, -1
/// if absent.
struct StrengthColumns {
  int velocity, mass, volume, stress, state, viscosity_pressure;
};

/// Artificial bulk viscosity (von Neumann & Richtmyer 1950, with Landshoff's linear term):
/// q = rho h^2 quadratic e^2 - rho h c linear e for a rate of volume change e < 0.
struct BulkViscosity {
  double quadratic = 0.0, linear = 0.0;
  bool active() const { return quadratic > 0.0 || linear > 0.0; }
};

struct StressSettings {
  double time_step, cell_size;
  BulkViscosity viscosity;
  bool
      forces_follow;  // USF: this step's forces use the new stress; else they have used the old one
};

/// What the ledger and the time step need from a block; energies in J.
struct StressSums {
  double internal = 0.0;     // recoverable work of the stress, mean of old and new
  double plastic = 0.0;      // plastic work
  double viscous = 0.0;      // work of the artificial viscosity
  double force_power = 0.0;  // work over this strain of the stress that the nodal forces use
  double fastest = 0.0;      // largest c + |v| [m/s]
  bool negative_volume = false;
};

template <class Model, class T, int D>
typename Model::template State<T, D> load_state(const Columns& columns, int first,
                                                auto&& load_component) {
  typename Model::template State<T, D> state;
  if constexpr (!Model::state_columns.empty()) {
    T flat[sizeof(state) / sizeof(T)];
    for (int k = 0; k < static_cast<int>(sizeof(state) / sizeof(T)); ++k)
      flat[k] = load_component(columns.component(first + k));
    std::memcpy(static_cast<void*>(&state), flat, sizeof(state));
  }
  return state;
}

/// Update stress, state and volume of the particles of a block, and add up what the ledger needs.
template <class Model, int D>
void update_strength(const Model& model, double initial_density, Columns& columns,
                     const StrengthColumns& at, const GradientBlock<D>& block,
                     const StressSettings& settings, StressSums& sums) {
  using T = Batch<native_lanes>;
  constexpr int W = native_lanes;
  using Stress = Sym<T, D>;
  T internal(0.0), plastic(0.0), viscous(0.0), force_power(0.0), fastest(0.0);
  auto negative = T(1.0) < T(0.0);

  for (std::size_t k = 0; k < block.count; k += W) {
    const LaneRows<W> rows(block.row + k, block.count - k);
    const auto valid = first_lanes<W>(rows.count);
    const auto read = [&](const double* column) { return load(column, rows); };

    Motion<T, D> motion;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        motion.gradient[i][j] = select(valid, T::load(&block.gradient[i][j][k]), T(0.0));
    Mat<T, D> f = motion.gradient;
    for (int i = 0; i < D; ++i) f[i][i] = f[i][i] + T(1.0);
    motion.volume_ratio = determinant(f);
    const T mass = read(columns.component(at.mass));
    const T volume_before = read(columns.component(at.volume));
    const T volume = volume_before * motion.volume_ratio;
    motion.J = volume * T(initial_density) / mass;
    negative = negative | (valid & !(volume > T(0.0)));

    Stress before;
    for (int c = 0; c < Stress::size; ++c) before.c[c] = read(columns.component(at.stress + c));
    auto state = load_state<Model, T, D>(columns, at.state, read);
    Stress stress = before;
    const T plastic_density = model.update(motion, stress, state);
    const T c = model.sound_speed(stress, state, motion.J);

    store(columns.component(at.volume), rows, volume);
    for (int i = 0; i < Stress::size; ++i)
      store(columns.component(at.stress + i), rows, stress.c[i]);
    if constexpr (!Model::state_columns.empty()) {
      T flat[sizeof(state) / sizeof(T)];
      std::memcpy(flat, static_cast<const void*>(&state), sizeof(state));
      for (int i = 0; i < static_cast<int>(sizeof(state) / sizeof(T)); ++i)
        store(columns.component(at.state + i), rows, flat[i]);
    }

    // The forces work on the gradient as it is, the material on that of the middle of the step.
    const Sym<T, D> strain = symmetric_part(motion.gradient);
    const T mean_volume = T(0.5) * (volume_before + volume);
    const T work =
        T(0.5) * mean_volume * inner(before + stress, symmetric_part(mid_step(motion.gradient)));
    const T lost = mean_volume * plastic_density;
    T used = settings.forces_follow ? volume * inner(stress, strain)
                                    : volume_before * inner(before, strain);
    if (settings.viscosity.active()) {
      const T rate = min(trace(strain), T(0.0)) * T(settings.cell_size / settings.time_step);
      const T density = mass / volume;
      const T q = density * rate *
                  (T(settings.viscosity.quadratic) * rate - T(settings.viscosity.linear) * c);
      const T q_before = read(columns.component(at.viscosity_pressure));
      store(columns.component(at.viscosity_pressure), rows, q);
      viscous += select(valid, -volume * q * trace(strain), T(0.0));
      used -= (settings.forces_follow ? volume * q : volume_before * q_before) * trace(strain);
    }
    internal += select(valid, work - lost, T(0.0));
    plastic += select(valid, lost, T(0.0));
    force_power += select(valid, used, T(0.0));

    Vec<T, D> v;
    for (int a = 0; a < D; ++a) v[a] = read(columns.component(at.velocity + a));
    fastest = max(fastest, c + sqrt(dot(v, v)));
  }
  sums.internal += sum(internal);
  sums.plastic += sum(plastic);
  sums.viscous += sum(viscous);
  sums.force_power += sum(force_power);
  sums.fastest = max(sums.fastest, largest(fastest));
  sums.negative_volume = sums.negative_volume || any(negative);
}

}  // namespace mpm
