#pragma once
#include <array>

#include "mpm/materials/eos/murnaghan.hpp"

namespace mpm {

/// Tait's water, p = rho0 c0^2 / n ((rho / rho0)^n - 1).
struct Tait {
  static constexpr std::string_view name = "tait";
  static constexpr std::string_view doc =
      "Tait's liquid, p = rho0 c0^2/n ((rho/rho0)^n - 1); a c0 of ten times the fastest flow makes "
      "a "
      "weakly compressible liquid";
  static constexpr std::string_view source = "Cole 1948, eq. 2.11; Monaghan 1994, eq. 2.7";

  double c0{}, n{};
  double stiffness{};

  static constexpr auto params = std::array{
      Param<Tait>{"c0", &Tait::c0, "m/s", "speed of sound at the start", Rule::positive},
      Param<Tait>{"n", &Tait::n, "", "exponent", Rule::positive, 7.0},
  };

  void prepare(double density) { stiffness = density * c0 * c0; }
  std::string problem() const { return {}; }
  MPM_HD double initial_energy() const { return 0.0; }
  MPM_HD double energy_at_zero(double) const { return -unbounded; }
  MPM_HD bool is_gas() const { return false; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    return power_of_density(V, stiffness, n);
  }
};

}  // namespace mpm
