#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// p = K (rho / rho0 - 1).
struct LinearBulk {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view doc =
      "pressure proportional to compression, p = K (rho/rho0 - 1); with K = rho0 c^2 the weakly "
      "compressible fluid of sound speed c";
  static constexpr std::string_view source = "the definition of the bulk modulus";

  double K{};

  static constexpr auto params = std::array{
      Param<LinearBulk>{"K", &LinearBulk::K, "Pa", "bulk modulus", Rule::positive},
  };

  void prepare(double) {}
  std::string problem() const { return {}; }
  MPM_HD double initial_energy() const { return 0.0; }
  MPM_HD double energy_at_zero(double) const { return -unbounded; }
  MPM_HD bool is_gas() const { return false; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    const T density = T(1.0) / V;
    return {T(K) * (density - T(1.0)), T(0.0), T(-K) * density * density, T(0.0)};
  }
};

}  // namespace mpm
