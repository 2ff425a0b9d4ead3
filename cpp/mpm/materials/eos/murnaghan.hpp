#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// p = K0 / n ((rho / rho0)^n - 1).
template <class T>
MPM_HD LinearInEnergy<T> power_of_density(T V, double K0, double n) {
  const T power = pow(V, T(-n));
  return {T(K0 / n) * (power - T(1.0)), T(0.0), T(-K0) * power / V, T(0.0)};
}

/// Murnaghan: the bulk modulus grows linearly with pressure, K = K0 + n p.
struct Murnaghan {
  static constexpr std::string_view name = "murnaghan";
  static constexpr std::string_view doc =
      "bulk modulus linear in pressure, p = K0/n ((rho/rho0)^n - 1)";
  static constexpr std::string_view source = "Murnaghan 1944, eq. 3";

  double K0{}, n{};

  static constexpr auto params = std::array{
      Param<Murnaghan>{"K0", &Murnaghan::K0, "Pa", "bulk modulus at zero pressure", Rule::positive},
      Param<Murnaghan>{"n", &Murnaghan::n, "", "dK/dp", Rule::positive},
  };

  void prepare(double) {}
  std::string problem() const { return {}; }
  MPM_HD double initial_energy() const { return 0.0; }
  MPM_HD double energy_at_zero(double) const { return -unbounded; }
  MPM_HD bool is_gas() const { return false; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    return power_of_density(V, K0, n);
  }
};

}  // namespace mpm
