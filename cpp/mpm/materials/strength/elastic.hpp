#pragma once
#include <array>

#include "mpm/materials/jaumann.hpp"

namespace mpm {

/// Isotropic hypoelasticity with the Jaumann rate: stress rate = lambda tr(D) 1 + 2 G D (Truesdell
/// & Noll 1965, sec. 99).
struct Elastic {
  static constexpr std::string_view name = "elastic";
  static constexpr std::string_view doc =
      "isotropic linear elasticity in rate form (hypoelastic, Jaumann rate); small elastic "
      "strains, any rotation";
  static constexpr std::string_view source =
      "Truesdell & Noll 1965, sec. 99; update after Hughes & Winget 1980";

  double E{}, nu{}, density{};
  double lambda{}, G{};

  static constexpr auto params = std::array{
      Param<Elastic>{"E", &Elastic::E, "Pa", "Young's modulus", Rule::positive},
      Param<Elastic>{"nu", &Elastic::nu, "", "Poisson's ratio", Rule::poisson_ratio},
  };
  static constexpr std::array<StateColumn, 0> state_columns{};
  template <class T, int D>
  using State = NoState<T, D>;

  void prepare(double initial_density) {
    density = initial_density;
    lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    G = E / (2.0 * (1.0 + nu));
  }

  template <Real T, int D>
  T update(const Motion<T, D>& motion, Sym<T, D>& stress, State<T, D>&) const {
    const Corotated<T, D> at_end = corotate(motion, stress);
    stress = at_end.stress + Sym<T, D>::isotropic(T(lambda) * trace(at_end.strain)) +
             T(2.0 * G) * at_end.strain;
    return T(0.0);
  }

  template <Real T, int D>
  T sound_speed(const Sym<T, D>&, const State<T, D>&, T J) const {
    return sqrt(T((lambda + 2.0 * G) / density) * J);
  }
};

}  // namespace mpm
