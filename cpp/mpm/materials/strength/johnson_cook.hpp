#pragma once
#include <array>

#include "mpm/materials/elastic_plastic.hpp"
#include "mpm/materials/johnson_cook_law.hpp"

namespace mpm {

/// Johnson and Cook's metal, heated by its plastic work.
struct JohnsonCook : ElasticPlastic<JohnsonCook> {
  using Self = JohnsonCook;
  static constexpr std::string_view name = "johnson_cook";
  static constexpr std::string_view doc =
      "metal at high rates, Y = (A + B ep^n) (1 + C ln(rate/rate0)) (1 - T*^m), "
      "T* = (T - T_room) / (T_melt - T_room), heated by the share chi of the plastic work "
      "(adiabatic)";
  static constexpr std::string_view source = "Johnson & Cook 1983, eqs. 1-2";

  double E{}, nu{}, A{}, B{}, n{}, C{}, rate0{}, m{}, T_room{}, T_melt{}, T0{}, cp{}, chi{};
  JohnsonCookLaw law{};

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"A", &Self::A, "Pa", "yield stress at the reference rate", Rule::positive},
      Param<Self>{"B", &Self::B, "Pa", "factor of hardening", Rule::not_negative},
      Param<Self>{"n", &Self::n, "", "exponent of hardening", Rule::positive},
      Param<Self>{"C", &Self::C, "", "factor of the rate", Rule::not_negative},
      Param<Self>{"rate0", &Self::rate0, "1/s", "reference rate", Rule::positive, 1.0},
      Param<Self>{"m", &Self::m, "", "exponent of softening", Rule::positive},
      Param<Self>{"T_room", &Self::T_room, "K", "reference temperature", Rule::not_negative, 298.0},
      Param<Self>{"T_melt", &Self::T_melt, "K", "melting temperature", Rule::positive},
      Param<Self>{"T0", &Self::T0, "K", "temperature at the start", Rule::positive, 298.0},
      Param<Self>{"cp", &Self::cp, "J/kg/K", "specific heat", Rule::positive},
      Param<Self>{"chi", &Self::chi, "", "share of the plastic work that heats", Rule::not_negative,
                  0.9},
  };

  static constexpr auto state_columns =
      std::array{StateColumn{"plastic_strain", "1"}, StateColumn{"temperature", "K"}};
  template <class T, int D>
  struct State {
    T plastic_strain, temperature;
  };
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {T(0.0), T(T0)};
  }

  void prepare(double density) {
    ElasticPlastic::prepare(density);
    law = {.A = A,
           .B = B,
           .C = C,
           .rate0 = rate0,
           .n = PowerNearOne(n),
           .m = PowerNearOne(m),
           .T_room = T_room,
           .T_melt = T_melt,
           .heating = chi / (density * cp)};
  }
  std::string problem() const {
    if (!(T_melt > T_room)) return "johnson_cook.T_melt must be > T_room";
    if (!(T0 < T_melt)) return "johnson_cook.T0 must be < T_melt";
    if (chi > 1.0) return "johnson_cook.chi must be <= 1";
    return {};
  }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    const Sym<T, D> before = stress;
    elastic.update(motion, stress);
    return law.update<true>(motion, elastic.G, before, stress, state.plastic_strain,
                            state.temperature);
  }
  template <Real T>
  MPM_HD T homologous(T temperature) const {
    return law.homologous(temperature);
  }
};

}  // namespace mpm
