#pragma once
// What a material model is: a small struct with named parameters and state, and its physics as
// templates over the number.
#include <concepts>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "mpm/catalogue/rule.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

inline constexpr double required = std::numeric_limits<double>::quiet_NaN();

/// A parameter as the user sees it. `start` is its default; NaN (`required`) means it must be
/// given.
template <class Model>
struct Param {
  std::string_view name;
  double Model::* member;
  std::string_view unit;
  std::string_view meaning;
  Rule rule = Rule::positive;
  double start = required;
};

enum class Shape { scalar, symmetric };

/// A state column that exists only for bodies whose material uses the model.
struct StateColumn {
  std::string_view name;
  std::string_view unit;
  Shape shape = Shape::scalar;
  MPM_HD constexpr int components(int dimension) const {
    return shape == Shape::scalar ? 1 : (dimension == 3 ? 6 : 4);
  }
};

/// How a strength model and an equation of state go together: the strength gives the whole stress
/// and takes none; it gives the whole stress, whose mean part an EOS may replace; it gives no
/// pressure and needs one.
enum class EosUse { never, may, must };

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// The motion of a particle over one step.
template <class T, int D>
struct StrainIncrement {
  Mat<T, D>
      gradient;  // velocity gradient x time step, on the configuration at the start of the step
  T J;           // volume after the step / initial volume
  double time_step = 0.0;  // [s]
  double time = 0.0;       // at the end of the step [s]
  double cell_size = 0.0;  // [m]
};

/// The gradient referred to the middle of the step: L (1 + L/2)^-1 = L - L^2/2 + O(L^3).
template <class T, int D>
MPM_HD Mat<T, D> mid_step(const Mat<T, D>& gradient) {
  const Mat<T, D> square = gradient * gradient;
  Mat<T, D> middle;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) middle[i][j] = fma(T(-0.5), square[i][j], gradient[i][j]);
  return middle;
}

/// A gradient on the configuration at the end of the step, seen from its start: L (1 - L)^-1. Where
/// x' = x + dt v, F^-1 = 1 - L at the end, and F - 1 is the gradient that `StrainIncrement` means.
/// By Cayley and Hamilton the adjugate of 1 - L needs L^2 alone, in 2D not even that.
template <class T>
MPM_HD Mat<T, 2> seen_from_start(const Mat<T, 2>& L) {
  const T det = determinant(L), per = T(1.0) / (T(1.0) - L[0][0] - L[1][1] + det);
  return {{{(L[0][0] - det) * per, L[0][1] * per}, {L[1][0] * per, (L[1][1] - det) * per}}};
}
template <class T>
MPM_HD Mat<T, 3> seen_from_start(const Mat<T, 3>& L) {
  const Mat<T, 3> square = L * L;
  const T det = determinant(L), first = L[0][0] + L[1][1] + L[2][2];
  const T second = T(0.5) * (first * first - square[0][0] - square[1][1] - square[2][2]);
  const T per = T(1.0) / (T(1.0) - first + second - det);
  Mat<T, 3> seen;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      seen[i][j] = (fma(-first, L[i][j], L[i][j]) + square[i][j] + (i == j ? det : T(0.0))) * per;
  return seen;
}

/// Names, parameters and preparation, which models of every kind have. `problem` is a sentence
/// about parameters that do not go together, empty if they do.
template <class M>
concept Model = requires(M m, double density) {
  { M::name } -> std::convertible_to<std::string_view>;
  { M::doc } -> std::convertible_to<std::string_view>;
  { M::source } -> std::convertible_to<std::string_view>;
  M::params;
  m.prepare(density);
  { m.problem() } -> std::convertible_to<std::string>;
};

/// A strength model: stress and state after a step from those before it, eq. (18)-(20) and the
/// constitutive law. `update` must leave stress and state as they are for a zero gradient, rates
/// and burning apart, and returns the work [J/m^3, present volume] that the step has dissipated by
/// plastic or viscous flow.
///
/// Plastic work: where the yield stress Y depends on the plastic strain alone, the mean of Y before
/// and after the step times the increment, the integral of Y to second order. Where rate,
/// temperature or direction of flow count too, the stress after the step times the increment of
/// plastic strain, which is what the return solves for: first order.
///
/// `sound_speed` [m/s] bounds the fastest wave. Where an EOS gives the pressure,
/// `other_speed_squared` [m^2/s^2] is added to the square of the EOS's speed of sound: 4 G / (3
/// rho) for a solid, nothing for a fluid, the square of the front's speed for an explosive until it
/// has burnt.
template <class M>
concept StrengthModel =
    Model<M> && requires(M m, StrainIncrement<double, 3> motion, Sym<double, 3> stress,
                         typename M::template State<double, 3> state, double J) {
      { M::eos } -> std::convertible_to<EosUse>;
      M::state_columns;
      { m.template start<double, 3>() } -> std::same_as<typename M::template State<double, 3>>;
      { m.update(motion, stress, state) } -> std::convertible_to<double>;
      requires M::eos == EosUse::must || requires { m.sound_speed(stress, state, J); };
      requires M::eos == EosUse::never || requires { m.other_speed_squared(state, J); };
    };

/// A strength model that burns: the EOS's pressure counts by its burn fraction.
template <class M>
concept Burns = requires(typename M::template State<double, 3> state) { state.burn_fraction; };
/// A strength model of matter without a shape of its own, gases and liquids, has `flows`; one of
/// loose matter, soils, `breaks_up`.
/// A strength model with a viscosity: `damping_speed(J, h)` is 4/3 of it over density and cell size
/// [m/s].
template <class M>
concept Damps = requires(M m) { m.damping_speed(1.0, 1.0); };

/// An equation of state at one relative volume V: pressure A + B E, E the internal energy per
/// initial volume [Pa], and the derivatives of A and B with V.
template <class T>
struct LinearInEnergy {
  T A, B, dA, dB;

  MPM_HD T pressure(T energy) const { return A + B * energy; }

  /// The same of which a fraction has burnt: programmed burn multiplies the pressure.
  MPM_HD LinearInEnergy burnt(T fraction) const {
    return {fraction * A, fraction * B, fraction * dA, fraction * dB};
  }
};

inline constexpr double opened_volume = 1.2;  // over that at the start; beyond: debris or vapour

/// The pressure of a law that is made for a solid near its initial density, at any `density`
/// rho / rho0: beyond `opened_volume` both parts fall with the density. As the law has them they
/// would tend to a tension of about the bulk modulus, and to a gamma that grows with the volume,
/// however much of that is void.
template <class T>
MPM_HD LinearInEnergy<T> opened(const LinearInEnergy<T>& solid, T density) {
  const T share = min(T(opened_volume) * density, T(1.0));
  const T slope = select(share < T(1.0), -share * density, T(0.0));  // d share / dV
  return {share * solid.A, share * solid.B, share * solid.dA + slope * solid.A,
          share * solid.dB + slope * solid.B};
}

/// One that is linear in the energy, by `at(V)` ...
template <class M>
concept LinearEos = requires(M m, double V) {
  { m.at(V) } -> std::same_as<LinearInEnergy<double>>;
};
/// ... or any other, by `tangent(V, E)`: B = dp/dE, A = p - B E, dA = dp/dV and dB = 0 there.
template <class M>
concept NonlinearEos = requires(M m, double V, double E) {
  { m.tangent(V, E) } -> std::same_as<LinearInEnergy<double>>;
};

/// The pressure about an energy, whichever way the model gives it.
template <class T, class M>
MPM_HD LinearInEnergy<T> line_of(const M& eos, T V, T energy) {
  if constexpr (LinearEos<M>)
    return eos.at(V);
  else
    return eos.tangent(V, energy);
}

/// An equation of state. `initial_energy` [J/m^3] is the internal energy at the start,
/// `energy_at_zero(heat)` the least that there is, at absolute zero, where the material holds
/// `heat` [J/m^3] at the start (infinite if that is unknown); minus infinity where the pressure
/// does not depend on it. A gas, as products of detonation are, fills any volume.
template <class M>
concept EosModel = Model<M> && (LinearEos<M> || NonlinearEos<M>) && requires(M m) {
  { m.initial_energy() } -> std::convertible_to<double>;
  { m.energy_at_zero(1.0) } -> std::convertible_to<double>;
  { m.is_gas() } -> std::same_as<bool>;
};

/// What a failure model may judge by: of the end of a step, but for the energy, which is that of
/// its start, as the work of the step is known only when failure has changed the stress.
template <class T, int D>
struct Condition {
  Sym<T, D> stress;    // [Pa]
  Mat<T, D> gradient;  // as in StrainIncrement
  T plastic_strain, plastic_increment;
  T temperature;  // homologous, 0 at the reference and 1 at melting; 0 without a thermal model
  T energy;  // internal, per initial volume, at the start of the step [J/m^3]; 0 without an EOS
  double time_step = 0.0;
};

/// A failure model: `damage` returns how far the particle has come, 1 and more for failed. It says
/// whether it needs a plastic strain from the strength model, and an internal energy, so an EOS.
template <class M>
concept FailureModel = Model<M> && requires(M m, Condition<double, 3> condition,
                                            typename M::template State<double, 3> state) {
  { M::needs_plasticity } -> std::convertible_to<bool>;
  { M::needs_energy } -> std::convertible_to<bool>;
  M::state_columns;
  { m.template start<double, 3>() } -> std::same_as<typename M::template State<double, 3>>;
  { m.damage(condition, state) } -> std::convertible_to<double>;
};

/// For models without state.
template <class T, int D>
struct NoState {};

/// The number of values of a state, and a state from them and back. Lanes are plain vectors that
/// may be copied by their bytes, though `Batch` has a copy constructor.
template <class State, class T>
inline constexpr int state_size =
    std::is_empty_v<State> ? 0 : static_cast<int>(sizeof(State) / sizeof(T));  // NOLINT: all Ts

template <class State, class T>
MPM_HD State unpack(const T* values) {
  State state;
  if constexpr (!std::is_empty_v<State>)
    std::memcpy(static_cast<void*>(&state), static_cast<const void*>(values), sizeof(state));
  return state;
}
template <class State, class T>
MPM_HD void pack(const State& state, T* values) {
  if constexpr (!std::is_empty_v<State>)
    std::memcpy(static_cast<void*>(values), static_cast<const void*>(&state), sizeof(state));
}

}  // namespace mpm
