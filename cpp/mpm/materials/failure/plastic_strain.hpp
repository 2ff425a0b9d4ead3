#pragma once
#include "mpm/materials/one_limit.hpp"

namespace mpm {

/// Fails at a given equivalent plastic strain.
struct PlasticStrainLimit : OneLimit {
  static constexpr std::string_view name = "plastic_strain";
  static constexpr std::string_view doc = "fails when the equivalent plastic strain reaches limit";
  static constexpr std::string_view source = "Ma, Zhang & Huang 2010, sec. 3.2";
  static constexpr bool needs_plasticity = true;

  static constexpr auto params = one_limit("", "equivalent plastic strain");

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>&) const {
    return at.plastic_strain * T(1.0 / limit);
  }
};

}  // namespace mpm
