#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Tillotson, for hypervelocity impact: with eta = rho/rho0, mu = eta - 1, E per initial volume and
/// E0 = rho0 e0, compressed or cold
///   p_c = (a + b / (E/(E0 eta^2) + 1)) eta E + A mu + B mu^2,
/// expanded and vaporised (e > e_cv)
///   p_e = a eta E + (b eta E / (E/(E0 eta^2) + 1) + A mu exp(-beta (1/eta - 1)))
///         exp(-alpha (1/eta - 1)^2),
/// and between e_iv and e_cv, while it boils, linear in e from one to the other.
struct Tillotson {
  static constexpr std::string_view name = "tillotson";
  static constexpr std::string_view doc =
      "Tillotson, solid to vapour, for hypervelocity impact; below e_iv p = (a + b/(e/(e0 eta^2) + "
      "1)) rho e + A mu + B mu^2, eta = rho/rho0 = mu + 1";
  static constexpr std::string_view source = "Tillotson 1962, GA-3216; Melosh 1989, appendix II";

  double a{}, b{}, A{}, B{}, alpha{}, beta{}, e0{}, e_iv{}, e_cv{}, spall_strength{};
  double E0{}, E_iv{}, E_cv{};  // the energies per initial volume [J/m^3]

  static constexpr auto params = std::array{
      Param<Tillotson>{"a", &Tillotson::a, "", "Grueneisen's gamma of the hot gas", Rule::positive},
      Param<Tillotson>{"b", &Tillotson::b, "", "a + b is Grueneisen's gamma of the cold solid",
                       Rule::not_negative},
      Param<Tillotson>{"A", &Tillotson::A, "Pa", "bulk modulus", Rule::positive},
      Param<Tillotson>{"B", &Tillotson::B, "Pa", "factor of mu^2", Rule::not_negative},
      Param<Tillotson>{"alpha", &Tillotson::alpha, "", "decay of the solid's share in the vapour",
                       Rule::not_negative, 5.0},
      Param<Tillotson>{"beta", &Tillotson::beta, "", "decay of its cold pressure",
                       Rule::not_negative, 5.0},
      Param<Tillotson>{"e0", &Tillotson::e0, "J/kg", "energy that parts a + b from a",
                       Rule::positive},
      Param<Tillotson>{"e_iv", &Tillotson::e_iv, "J/kg", "energy at which it begins to boil",
                       Rule::positive},
      Param<Tillotson>{"e_cv", &Tillotson::e_cv, "J/kg", "energy at which it is vapour",
                       Rule::positive},
      Param<Tillotson>{"spall_strength", &Tillotson::spall_strength, "Pa",
                       "largest tension that the pressure becomes; 0 for no limit",
                       Rule::not_negative, 0.0},
  };

  void prepare(double density) {
    E0 = density * e0;
    E_iv = density * e_iv;
    E_cv = density * e_cv;
  }
  std::string problem() const {
    return e_cv > e_iv ? std::string() : "tillotson.e_cv must be > e_iv";
  }
  MPM_HD double initial_energy() const { return 0.0; }
  /// As far below the start as its heat, if that is known, or as what boils it.
  MPM_HD double energy_at_zero(double heat) const { return -min(heat, E_iv); }
  MPM_HD bool is_gas() const { return false; }

  template <Real T>
  MPM_HD LinearInEnergy<T> tangent(T V, T energy) const {
    const T eta = T(1.0) / V, mu = eta - T(1.0), x = V - T(1.0);
    // b's term in g eta E; below the energy of the start as at it.
    const T heat = max(energy, T(0.0)), q = T(1.0) + heat * V * V * T(1.0 / E0);
    const T g = T(b) / q, g_by_q = -g / q;
    const T g_E = select(energy > T(0.0), g_by_q * V * V * T(1.0 / E0), T(0.0));
    const T g_V = g_by_q * T(2.0) * heat * V * T(1.0 / E0);
    const T solid = g * eta * energy;
    const T solid_E = eta * (g + g_E * energy), solid_V = eta * energy * (g_V - g * eta);
    const T gas = T(a) * eta * energy, gas_E = T(a) * eta, gas_V = -gas * eta;
    const T linear = T(A) * mu, linear_V = T(-A) * eta * eta;

    const T cold = gas + solid + linear + T(B) * mu * mu;
    const T cold_E = gas_E + solid_E;
    const T cold_V = gas_V + solid_V + linear_V - T(2.0 * B) * mu * eta * eta;

    const T fades = exp(T(-alpha) * x * x), part = exp(T(-beta) * x);
    const T bound = solid + linear * part;
    const T hot = gas + bound * fades;
    const T hot_E = gas_E + solid_E * fades;
    const T hot_V =
        gas_V +
        (solid_V + (linear_V - T(beta) * linear) * part - T(2.0 * alpha) * x * bound) * fades;

    // The share of vapour; a compressed solid does not boil.
    const double between = 1.0 / (E_cv - E_iv);
    const T boiled = (energy - T(E_iv)) * T(between);
    const auto boils = (V > T(1.0)) & (boiled > T(0.0));
    const T w = select(boils, min(boiled, T(1.0)), T(0.0));
    const T w_E = select(boils & (boiled < T(1.0)), T(between), T(0.0));
    const T p = cold + w * (hot - cold);
    const T p_E = cold_E + w * (hot_E - cold_E) + w_E * (hot - cold);
    return {p - p_E * energy, p_E, cold_V + w * (hot_V - cold_V), T(0.0)};
  }
};

}  // namespace mpm
