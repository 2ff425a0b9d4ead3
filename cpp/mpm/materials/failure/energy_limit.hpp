#pragma once
#include "mpm/materials/one_limit.hpp"

namespace mpm {

/// Fails at a given internal energy.
struct EnergyLimit : OneLimit {
  static constexpr std::string_view name = "energy_limit";
  static constexpr std::string_view doc =
      "fails when the internal energy per initial volume, at the start of the step, reaches limit";
  static constexpr std::string_view source = "the definition of the internal energy";
  static constexpr bool needs_energy = true;

  static constexpr auto params = one_limit("J/m^3", "internal energy per initial volume");

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>&) const {
    return at.energy * T(1.0 / limit);
  }
};

}  // namespace mpm
