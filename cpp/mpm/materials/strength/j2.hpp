#pragma once
#include <array>

#include "mpm/materials/elastic_plastic.hpp"

namespace mpm {

/// Elastic, then plastic at von Mises' yield stress Y0 + H ep, ep the equivalent plastic strain:
/// perfectly plastic for H = 0, isotropic linear hardening otherwise.
struct J2 : ElasticPlastic<J2> {
  using Self = J2;
  static constexpr std::string_view name = "j2";
  static constexpr std::string_view doc =
      "von Mises plasticity: perfectly plastic, or isotropic linear hardening with H > 0";
  static constexpr std::string_view source =
      "von Mises 1913; radial return after Wilkins 1964 and Krieg & Key 1976";

  double E{}, nu{}, Y0{}, H{};

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"Y0", &Self::Y0, "Pa", "yield stress in tension at the start", Rule::positive},
      Param<Self>{"H", &Self::H, "Pa", "plastic modulus dY/dep (= E Et / (E - Et))",
                  Rule::not_negative, 0.0},
  };

  /// The elastic stress, and where its von Mises stress q exceeds Y the deviator returned along its
  /// own direction: q = Y holds after it, as 3 G dep = q_trial - Y(ep + dep) is linear in dep.
  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    elastic.update(motion, stress);
    const Sym<T, D> mean = Sym<T, D>::isotropic(T(1.0 / 3.0) * trace(stress));
    const Sym<T, D> deviator = stress - mean;
    const T q = sqrt(T(1.5) * inner(deviator, deviator));
    const T yield = T(Y0) + T(H) * state.plastic_strain;
    const T increment = max(q - yield, T(0.0)) * T(1.0 / (3.0 * elastic.G + H));
    const T left = select(q > yield, T(1.0) - T(3.0 * elastic.G) * increment / q, T(1.0));
    stress = mean + left * deviator;
    state.plastic_strain += increment;
    return (yield + T(0.5 * H) * increment) * increment;
  }
};

}  // namespace mpm
