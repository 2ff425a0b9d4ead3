#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Jones-Wilkins-Lee: p = A (1 - w/(R1 V)) exp(-R1 V) + B (1 - w/(R2 V)) exp(-R2 V) + w E / V.
struct Jwl {
  static constexpr std::string_view name = "jwl";
  static constexpr std::string_view doc =
      "Jones-Wilkins-Lee, the products of detonation: p = A (1 - w/(R1 V)) exp(-R1 V) + B (1 - "
      "w/(R2 "
      "V)) exp(-R2 V) + w E/V, V = rho0/rho";
  static constexpr std::string_view source = "Lee, Hornig & Kury 1968, UCRL-50422";

  double A{}, B{}, R1{}, R2{}, omega{}, E0{};

  static constexpr auto params = std::array{
      Param<Jwl>{"A", &Jwl::A, "Pa", "factor of exp(-R1 V)", Rule::positive},
      Param<Jwl>{"B", &Jwl::B, "Pa", "factor of exp(-R2 V)", Rule::any},
      Param<Jwl>{"R1", &Jwl::R1, "", "first exponent", Rule::positive},
      Param<Jwl>{"R2", &Jwl::R2, "", "second exponent", Rule::positive},
      Param<Jwl>{"omega", &Jwl::omega, "", "Grueneisen's gamma of the gas", Rule::positive},
      Param<Jwl>{"E0", &Jwl::E0, "Pa", "internal energy per initial volume", Rule::positive},
  };

  void prepare(double) {}
  std::string problem() const { return {}; }
  MPM_HD double initial_energy() const { return E0; }
  MPM_HD double energy_at_zero(double) const { return 0.0; }
  MPM_HD bool is_gas() const { return true; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    const T density = T(1.0) / V, w(omega);
    const T one = T(A) * exp(T(-R1) * V), two = T(B) * exp(T(-R2) * V);
    const T f1 = T(1.0) - T(omega / R1) * density, f2 = T(1.0) - T(omega / R2) * density;
    const T d1 = T(omega / R1) * density * density, d2 = T(omega / R2) * density * density;
    return {one * f1 + two * f2, w * density, one * (d1 - T(R1) * f1) + two * (d2 - T(R2) * f2),
            -w * density * density};
  }
};

}  // namespace mpm
