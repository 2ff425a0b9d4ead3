#pragma once
#include <array>

#include "mpm/materials/elastic_plastic.hpp"
#include "mpm/materials/johnson_cook_law.hpp"

namespace mpm {

/// Johnson and Cook's metal without temperature.
struct SimplifiedJohnsonCook : ElasticPlastic<SimplifiedJohnsonCook> {
  using Self = SimplifiedJohnsonCook;
  static constexpr std::string_view name = "simplified_johnson_cook";
  static constexpr std::string_view doc =
      "metal at high rates without temperature, Y = (A + B ep^n) (1 + C ln(rate/rate0))";
  static constexpr std::string_view source = "Johnson & Cook 1983, eq. 1, without its last factor";

  double E{}, nu{}, A{}, B{}, n{}, C{}, rate0{};
  JohnsonCookLaw law{};

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"A", &Self::A, "Pa", "yield stress at the reference rate", Rule::positive},
      Param<Self>{"B", &Self::B, "Pa", "factor of hardening", Rule::not_negative},
      Param<Self>{"n", &Self::n, "", "exponent of hardening", Rule::positive},
      Param<Self>{"C", &Self::C, "", "factor of the rate", Rule::not_negative},
      Param<Self>{"rate0", &Self::rate0, "1/s", "reference rate", Rule::positive, 1.0},
  };

  void prepare(double density) {
    ElasticPlastic::prepare(density);
    law = {.A = A, .B = B, .C = C, .rate0 = rate0, .n = PowerNearOne(n)};
  }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    const Sym<T, D> before = stress;
    elastic.update(motion, stress);
    T no_temperature(0.0);
    return law.update<false>(motion, elastic.G, before, stress, state.plastic_strain,
                             no_temperature);
  }
};

}  // namespace mpm
