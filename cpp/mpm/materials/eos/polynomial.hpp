#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// p = c0 + c1 mu + c2 mu^2 + c3 mu^3 + (c4 + c5 mu + c6 mu^2) E, mu = rho / rho0 - 1. In tension
/// the even terms c2 and c6 are left out (Hallquist 2006, eq. 19.1.1). A gas, without
/// c1, is given for any density; all others are `opened`.
struct Polynomial {
  static constexpr std::string_view name = "polynomial";
  static constexpr std::string_view doc =
      "p = c0 + c1 mu + c2 mu^2 + c3 mu^3 + (c4 + c5 mu + c6 mu^2) E, mu = rho/rho0 - 1; without "
      "c2 and c6 in tension; with c1, beyond 1.2 of the initial volume p falls with the density";
  static constexpr std::string_view source = "Hallquist 2006 (LS-DYNA theory manual), sec. 19.1";

  double c0{}, c1{}, c2{}, c3{}, c4{}, c5{}, c6{}, E0{};

  static constexpr auto params = std::array{
      Param<Polynomial>{"c0", &Polynomial::c0, "Pa", "pressure at the start", Rule::any, 0.0},
      Param<Polynomial>{"c1", &Polynomial::c1, "Pa", "bulk modulus", Rule::not_negative, 0.0},
      Param<Polynomial>{"c2", &Polynomial::c2, "Pa", "factor of mu^2", Rule::any, 0.0},
      Param<Polynomial>{"c3", &Polynomial::c3, "Pa", "factor of mu^3", Rule::any, 0.0},
      Param<Polynomial>{"c4", &Polynomial::c4, "", "factor of E", Rule::any, 0.0},
      Param<Polynomial>{"c5", &Polynomial::c5, "", "factor of mu E", Rule::any, 0.0},
      Param<Polynomial>{"c6", &Polynomial::c6, "", "factor of mu^2 E", Rule::any, 0.0},
      Param<Polynomial>{"E0", &Polynomial::E0, "Pa", "internal energy per initial volume",
                        Rule::not_negative, 0.0},
  };

  void prepare(double) {}
  std::string problem() const {
    if (c1 > 0.0 || (c4 + c5 != 0.0 && E0 > 0.0)) return {};
    return "polynomial has no stiffness at the start: give c1 > 0, or c4 or c5 with E0 > 0";
  }
  MPM_HD double initial_energy() const { return E0; }
  /// As in MieGruneisen, with c4 for gamma0; without c1 it is a gas.
  MPM_HD double energy_at_zero(double heat) const {
    return is_gas() ? 0.0 : E0 - min(heat, c4 > 0.0 ? c1 / c4 : unbounded);
  }
  MPM_HD bool is_gas() const { return c1 == 0.0; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    const T density = T(1.0) / V, mu = density - T(1.0);
    const T d_mu = -density * density;
    const T two = select(mu > T(0.0), T(c2), T(0.0)), six = select(mu > T(0.0), T(c6), T(0.0));
    const LinearInEnergy<T> about{T(c0) + mu * (T(c1) + mu * (two + mu * T(c3))),
                                  T(c4) + mu * (T(c5) + mu * six),
                                  d_mu * (T(c1) + mu * (T(2.0) * two + mu * T(3.0 * c3))),
                                  d_mu * (T(c5) + T(2.0) * mu * six)};
    return is_gas() ? about : opened(about, density);
  }
};

}  // namespace mpm
