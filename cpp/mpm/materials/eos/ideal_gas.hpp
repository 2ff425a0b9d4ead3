#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// p = (gamma - 1) E rho / rho0.
struct IdealGas {
  static constexpr std::string_view name = "ideal_gas";
  static constexpr std::string_view doc =
      "ideal gas of constant heats, p = (gamma - 1) E rho/rho0; E0 = p0 / (gamma - 1) gives the "
      "pressure p0 at the start";
  static constexpr std::string_view source = "Toro 2009, eq. 1.22";

  double gamma{}, E0{};

  static constexpr auto params = std::array{
      Param<IdealGas>{"gamma", &IdealGas::gamma, "", "ratio of heats, > 1", Rule::positive},
      Param<IdealGas>{"E0", &IdealGas::E0, "Pa", "internal energy per initial volume",
                      Rule::positive},
  };

  void prepare(double) {}
  std::string problem() const {
    return gamma > 1.0 ? std::string() : "ideal_gas.gamma must be > 1";
  }
  MPM_HD double initial_energy() const { return E0; }
  MPM_HD double energy_at_zero(double) const { return 0.0; }
  MPM_HD bool is_gas() const { return true; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    const T B = T(gamma - 1.0) / V;
    return {T(0.0), B, T(0.0), -B / V};
  }
};

}  // namespace mpm
