#pragma once
#include <array>

#include "mpm/materials/johnson_cook_law.hpp"
#include "mpm/materials/strength/elastic.hpp"

namespace mpm {

/// Johnson and Cook's metal without temperature.
struct SimplifiedJohnsonCook {
  using Self = SimplifiedJohnsonCook;
  static constexpr std::string_view name = "simplified_johnson_cook";
  static constexpr std::string_view doc =
      "metal at high rates without temperature, Y = (A + B ep^n) (1 + C ln(rate/rate0))";
  static constexpr std::string_view source = "Johnson & Cook 1983, eq. 1, without its last factor";
  static constexpr EosUse eos = EosUse::may;

  double E{}, nu{}, A{}, B{}, n{}, C{}, rate0{};
  Elastic elastic{};
  JohnsonCookLaw law{};

  static constexpr auto params = std::array{
      Param<Self>{"E", &Self::E, "Pa", "Young's modulus", Rule::positive},
      Param<Self>{"nu", &Self::nu, "", "Poisson's ratio", Rule::poisson_ratio},
      Param<Self>{"A", &Self::A, "Pa", "yield stress at the reference rate", Rule::positive},
      Param<Self>{"B", &Self::B, "Pa", "factor of hardening", Rule::not_negative},
      Param<Self>{"n", &Self::n, "", "exponent of hardening", Rule::positive},
      Param<Self>{"C", &Self::C, "", "factor of the rate", Rule::not_negative},
      Param<Self>{"rate0", &Self::rate0, "1/s", "reference rate", Rule::positive, 1.0},
  };
  static constexpr auto state_columns = plastic_state_columns;
  template <class T, int D>
  using State = PlasticState<T, D>;
  template <class T, int D>
  State<T, D> start() const {
    return {T(0.0)};
  }

  void prepare(double density) {
    elastic = Elastic::of(E, nu, density);
    law.A = A;
    law.B = B;
    law.n = n;
    law.C = C;
    law.rate0 = rate0;
  }
  std::string problem() const { return {}; }

  template <Real T, int D>
  T update(const Motion<T, D>& motion, Sym<T, D>& stress, State<T, D>& state) const {
    const Sym<T, D> before = stress;
    elastic.update(motion, stress);
    T no_temperature(0.0);
    return law.update(motion, elastic.G, before, stress, state.plastic_strain, no_temperature);
  }

  template <Real T, int D>
  T sound_speed(const Sym<T, D>&, const State<T, D>&, T J) const {
    return elastic.sound_speed(J);
  }
  template <Real T, int D>
  T shear_wave_squared(const State<T, D>&, T J, double) const {
    return elastic.shear_wave_squared(J);
  }
};

}  // namespace mpm
