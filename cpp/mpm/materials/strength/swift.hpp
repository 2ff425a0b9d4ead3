#pragma once
#include <array>

#include "mpm/materials/elastic_plastic.hpp"

namespace mpm {

/// Von Mises plasticity with power hardening, Y = Y0 (1 + ep / e0)^n.
struct Swift : MisesPlastic<Swift> {
  using Self = Swift;
  static constexpr std::string_view name = "swift";
  static constexpr std::string_view doc =
      "von Mises plasticity with power hardening, Y = Y0 (1 + ep/e0)^n";
  static constexpr std::string_view source = "Swift 1952";

  double E{}, nu{}, Y0{}, e0{}, n{};

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"Y0", &Self::Y0, "Pa", "yield stress in tension at the start", Rule::positive},
      Param<Self>{"e0", &Self::e0, "", "reference strain", Rule::positive},
      Param<Self>{"n", &Self::n, "", "exponent of hardening", Rule::not_negative},
  };

  /// Yield stress and its slope at a plastic strain.
  template <Real T>
  MPM_HD Yield<T> yield(T plastic_strain) const {
    const T stretched = T(1.0) + T(1.0 / e0) * plastic_strain;
    const T value = T(Y0) * pow(stretched, T(n));
    return {value, T(n / e0) * value / stretched};
  }
};

}  // namespace mpm
