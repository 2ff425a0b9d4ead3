#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Compressible neo-Hookean rubber: energy per initial volume W = G/2 (tr b - 3) - G ln J +
/// lambda/2 (ln J)^2, so that J sigma = lambda ln J 1 + G (b - 1), with lambda = K - 2G/3 (Bonet &
/// Wood 2008, eqs. 6.27-6.29).
struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view doc =
      "compressible neo-Hookean, W = G/2 (tr b - 3) - G ln J + lambda/2 (ln J)^2, lambda = K - "
      "2G/3; large elastic strains";
  static constexpr std::string_view source = "Bonet & Wood 2008, eqs. 6.27-6.29";

  static constexpr EosUse eos = EosUse::never;

  double K{}, G{}, density{};
  double lambda{};

  static constexpr auto params = std::array{
      Param<NeoHookean>{"K", &NeoHookean::K, "Pa", "bulk modulus at small strain", Rule::positive},
      Param<NeoHookean>{"G", &NeoHookean::G, "Pa", "shear modulus at small strain", Rule::positive},
  };
  static constexpr auto state_columns =
      std::array{StateColumn{"left_cauchy_green", "", Shape::symmetric}};
  template <class T, int D>
  struct State {
    Sym<T, D> b;  // left Cauchy-Green tensor F F^T
  };
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {Sym<T, D>::isotropic(T(1.0))};
  }

  void prepare(double initial_density) {
    density = initial_density;
    lambda = K - 2.0 / 3.0 * G;
  }
  std::string problem() const { return {}; }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    Mat<T, D> f = motion.gradient;
    for (int i = 0; i < D; ++i) f[i][i] = f[i][i] + T(1.0);
    state.b = congruence(f, state.b);
    const T pressure_part = T(lambda) * log(motion.J) - T(G);
    stress = (T(1.0) / motion.J) * (Sym<T, D>::isotropic(pressure_part) + T(G) * state.b);
    return T(0.0);
  }

  /// rho c^2 = (lambda (1 - ln J) + G (1 + b_nn)) / J along n, from the spatial tangent; b_nn by
  /// Gershgorin's bound.
  template <Real T, int D>
  MPM_HD T sound_speed(const Sym<T, D>&, const State<T, D>& state, T J) const {
    T bound = state.b.c[2];
    for (int i = 0; i < D; ++i) {
      T row = state.b(i, i);
      for (int j = 0; j < D; ++j)
        if (j != i) row = row + max(state.b(i, j), -state.b(i, j));
      bound = max(bound, row);
    }
    const T stiffness = T(lambda) * (T(1.0) - log(J)) + T(G) * (T(1.0) + bound);
    return sqrt(max(stiffness, T(G)) * T(1.0 / density));
  }
};

}  // namespace mpm
