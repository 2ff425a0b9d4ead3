#pragma once
// What a material model is: a small struct with named parameters and state, and its physics as
// templates over the number.
#include <concepts>
#include <limits>
#include <string_view>

#include "mpm/math/tensor.hpp"

namespace mpm {

/// What values a parameter accepts.
enum class Rule { positive, not_negative, poisson_ratio, any };

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
enum class Start { zero, one, identity };

/// A state column that exists only for bodies whose material uses the model.
struct StateColumn {
  std::string_view name;
  std::string_view unit;
  Shape shape = Shape::scalar;
  Start start = Start::zero;
  constexpr int components(int dimension) const {
    return shape == Shape::scalar ? 1 : (dimension == 3 ? 6 : 4);
  }
};

/// The motion of a particle over one step.
template <class T, int D>
struct Motion {
  Mat<T, D>
      gradient;    // velocity gradient x time step, on the configuration at the start of the step
  T volume_ratio;  // det(1 + gradient): volume after / before the step
  T J;             // volume after the step / initial volume
};

/// The gradient referred to the middle of the step: L (1 + L/2)^-1 = L - L^2/2 + O(L^3).
template <class T, int D>
Mat<T, D> mid_step(const Mat<T, D>& gradient) {
  const Mat<T, D> square = gradient * gradient;
  Mat<T, D> middle;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) middle[i][j] = gradient[i][j] - T(0.5) * square[i][j];
  return middle;
}

/// A strength model: stress and state after a step from those before it, eq. (18)-(20) and the
/// constitutive law. `update` must leave everything as it is for a zero gradient, and returns the
/// plastic work of the step per present volume [J/m^3]. `sound_speed` [m/s] bounds the fastest
/// wave.
template <class M>
concept StrengthModel = requires(M m, Motion<double, 3> motion, Sym<double, 3> stress,
                                 typename M::template State<double, 3> state, double J) {
  { M::name } -> std::convertible_to<std::string_view>;
  { M::doc } -> std::convertible_to<std::string_view>;
  { M::source } -> std::convertible_to<std::string_view>;
  M::params;
  M::state_columns;
  m.prepare(J);
  { m.update(motion, stress, state) } -> std::convertible_to<double>;
  { m.sound_speed(stress, state, J) } -> std::convertible_to<double>;
};

/// For models without state.
template <class T, int D>
struct NoState {};

}  // namespace mpm
