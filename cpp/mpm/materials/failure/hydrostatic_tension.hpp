#pragma once
#include "mpm/materials/one_limit.hpp"

namespace mpm {

/// Spall: fails at a given mean stress, tension positive.
struct HydrostaticTensionLimit : OneLimit {
  static constexpr std::string_view name = "hydrostatic_tension";
  static constexpr std::string_view doc =
      "spall, fails when the mean stress, tension positive (minus the pressure), reaches limit";
  static constexpr std::string_view source = "Meyers 1994, sec. 16.8";

  static constexpr auto params = one_limit("Pa", "mean stress in tension");

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>&) const {
    return trace(at.stress) * T(1.0 / (3.0 * limit));
  }
};

}  // namespace mpm
