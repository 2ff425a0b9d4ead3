#pragma once
#include <array>

#include "mpm/materials/jaumann.hpp"

namespace mpm {

/// The two moduli as parameters of a model.
template <class Model>
constexpr Param<Model> youngs_modulus(double Model::* member) {
  return {"E", member, "Pa", "Young's modulus", Rule::positive};
}
template <class Model>
constexpr Param<Model> poissons_ratio(double Model::* member) {
  return {"nu", member, "", "Poisson's ratio", Rule::poisson_ratio};
}

/// Isotropic hypoelasticity with the Jaumann rate: stress rate = lambda tr(D) 1 + 2 G D (Truesdell
/// & Noll 1965, sec. 99).
struct Elastic {
  static constexpr std::string_view name = "elastic";
  static constexpr std::string_view doc =
      "isotropic linear elasticity in rate form (hypoelastic, Jaumann rate); small elastic "
      "strains, any rotation";
  static constexpr std::string_view source =
      "Truesdell & Noll 1965, sec. 99; update after Hughes & Winget 1980";

  static constexpr EosUse eos = EosUse::may;
  static constexpr bool by_rates = true;

  double E{}, nu{}, density{};
  double lambda{}, G{};

  static constexpr auto params =
      std::array{youngs_modulus(&Elastic::E), poissons_ratio(&Elastic::nu)};
  static constexpr std::array<StateColumn, 0> state_columns{};
  template <class T, int D>
  using State = NoState<T, D>;
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {};
  }

  void prepare(double initial_density) {
    density = initial_density;
    lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    G = E / (2.0 * (1.0 + nu));
  }
  std::string problem() const { return {}; }

  static Elastic of(double E, double nu, double density) {
    Elastic made;
    made.E = E;
    made.nu = nu;
    made.prepare(density);
    return made;
  }

  // For plastic models, whose elastic part this is.
  template <Real T, int D>
  MPM_HD void update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress) const {
    const Corotated<T, D> at_end = corotate(motion, stress);
    const Sym<T, D> with_volume =
        at_end.stress + Sym<T, D>::isotropic(T(lambda) * trace(at_end.strain));
    for (int c = 0; c < Sym<T, D>::size; ++c)
      stress.c[c] = fma(T(2.0 * G), at_end.strain.c[c], with_volume.c[c]);
  }
  template <Real T>
  MPM_HD T sound_speed(T J) const {
    return sqrt(T((lambda + 2.0 * G) / density) * J);
  }
  template <Real T>
  MPM_HD T other_speed_squared(T J) const {
    return T(4.0 / 3.0 * G / density) * J;
  }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress, State<T, D>&) const {
    update(motion, stress);
    return T(0.0);
  }
  template <Real T, int D>
  MPM_HD T sound_speed(const Sym<T, D>&, const State<T, D>&, T J) const {
    return sound_speed(J);
  }
  template <Real T, int D>
  MPM_HD T other_speed_squared(const State<T, D>&, T J) const {
    return other_speed_squared(J);
  }
};

}  // namespace mpm
