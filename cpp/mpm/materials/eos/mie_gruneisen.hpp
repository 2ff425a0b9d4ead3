#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Mie-Grueneisen about the Hugoniot Us = c0 + s up, with gamma rho = gamma0 rho0:
/// p = pH (1 - gamma0 eta / 2) + gamma0 E, pH = rho0 c0^2 eta / (1 - s eta)^2, eta = 1 - rho0 /
/// rho; in tension p = rho0 c0^2 (rho / rho0 - 1) + gamma0 E, and beyond 1.2 of the initial volume
/// 1.2 rho / rho0 of that.
struct MieGruneisen {
  static constexpr std::string_view name = "mie_gruneisen";
  static constexpr std::string_view doc =
      "Mie-Grueneisen about the shock Hugoniot Us = c0 + s up, gamma rho constant: p = pH (1 - "
      "gamma0 eta/2) + gamma0 E, pH = rho0 c0^2 eta / (1 - s eta)^2, eta = 1 - rho0/rho; linear in "
      "tension; beyond 1.2 of the initial volume p falls with the density";
  static constexpr std::string_view source =
      "Meyers 1994, eqs. 5.8 and 5.20; tension: Hallquist 2006";

  double c0{}, s{}, gamma0{}, E0{}, spall_strength{};
  double stiffness{};

  static constexpr auto params = std::array{
      Param<MieGruneisen>{"c0", &MieGruneisen::c0, "m/s", "bulk speed of sound", Rule::positive},
      Param<MieGruneisen>{"s", &MieGruneisen::s, "", "slope dUs/dup", Rule::not_negative},
      Param<MieGruneisen>{"gamma0", &MieGruneisen::gamma0, "", "Grueneisen's gamma at the start",
                          Rule::not_negative},
      Param<MieGruneisen>{"E0", &MieGruneisen::E0, "Pa", "internal energy per initial volume",
                          Rule::not_negative, 0.0},
      Param<MieGruneisen>{"spall_strength", &MieGruneisen::spall_strength, "Pa",
                          "largest tension that the pressure becomes; 0 for no limit",
                          Rule::not_negative, 0.0},
  };

  void prepare(double density) { stiffness = density * c0 * c0; }
  std::string problem() const { return {}; }
  MPM_HD double initial_energy() const { return E0; }
  /// Nothing lies below the energy that the heat of the start leaves when it is gone: every other
  /// state at absolute zero is one that this has been strained to. Where the heat is unknown it is
  /// less than what evaporates the solid: the isentrope of absolute zero, dE/dV = -p, ends for
  /// large V at rho0 c0^2 / gamma0, where the energy's pressure outweighs the tension rho0 c0^2.
  MPM_HD double energy_at_zero(double heat) const {
    return E0 - min(heat, gamma0 > 0.0 ? stiffness / gamma0 : unbounded);
  }
  MPM_HD bool is_gas() const { return false; }

  template <Real T>
  MPM_HD LinearInEnergy<T> at(T V) const {
    // The Hugoniot ends at eta = 1/s; a hundredth before it the denominator is held.
    const T eta = T(1.0) - V, free = T(1.0) - T(s) * eta, left = max(free, T(0.01));
    const T inverse = T(1.0) / left;
    const T hugoniot = T(stiffness) * eta * inverse * inverse;
    // d pH/d eta; where the denominator is held pH is linear.
    const T slope = T(stiffness) * inverse * inverse *
                    select(free < T(0.01), T(1.0), (T(1.0) + T(s) * eta) * inverse);
    const T factor = T(1.0) - T(0.5 * gamma0) * eta;
    const T density = T(1.0) / V;
    const auto compressed = eta > T(0.0);
    return opened<T>(
        {select(compressed, hugoniot * factor, T(stiffness) * (density - T(1.0))), T(gamma0),
         select(compressed, T(0.5 * gamma0) * hugoniot - slope * factor,
                T(-stiffness) * density * density),
         T(0.0)},
        density);
  }
};

}  // namespace mpm
