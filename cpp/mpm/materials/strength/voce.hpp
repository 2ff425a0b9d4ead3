#pragma once
#include <array>

#include "mpm/materials/elastic_plastic.hpp"

namespace mpm {

/// Von Mises plasticity with saturating hardening, Y = Y0 + Q (1 - exp(-b ep)).
struct Voce : MisesPlastic<Voce> {
  using Self = Voce;
  static constexpr std::string_view name = "voce";
  static constexpr std::string_view doc =
      "von Mises plasticity with saturating hardening, Y = Y0 + Q (1 - exp(-b ep))";
  static constexpr std::string_view source = "Voce 1948";

  double E{}, nu{}, Y0{}, Q{}, b{};

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"Y0", &Self::Y0, "Pa", "yield stress in tension at the start", Rule::positive},
      Param<Self>{"Q", &Self::Q, "Pa", "hardening at saturation", Rule::not_negative},
      Param<Self>{"b", &Self::b, "", "rate of saturation", Rule::not_negative},
  };

  /// Yield stress and its slope at a plastic strain.
  template <Real T>
  MPM_HD Yield<T> yield(T plastic_strain) const {
    const T left = T(Q) * exp(T(-b) * plastic_strain);
    return {T(Y0 + Q) - left, T(b) * left};
  }
};

}  // namespace mpm
