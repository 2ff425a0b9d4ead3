#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Johnson and Cook's accumulation of damage, the sum of dep / ef over the steps.
struct JohnsonCookDamage {
  using Self = JohnsonCookDamage;
  static constexpr std::string_view name = "johnson_cook_damage";
  static constexpr std::string_view doc =
      "fails when the damage, the sum of dep / ef, reaches 1; strain at fracture ef = (D1 + D2 "
      "exp(D3 s*)) (1 + D4 ln(rate/rate0)) (1 + D5 T*), s* = mean stress / von Mises stress, "
      "tension positive, at most 1.5: as Johnson and Cook write it, D3 is negative where tension "
      "embrittles "
      "(4340 steel: 0.05, 3.44, -2.12, 0.002, 0.61)";
  static constexpr std::string_view source = "Johnson & Cook 1985, eqs. 3 and 4";
  static constexpr bool needs_plasticity = true, needs_energy = false;
  static constexpr double largest_triaxiality = 1.5;  // that their formula was made for

  double D1{}, D2{}, D3{}, D4{}, D5{}, rate0{};

  static constexpr auto params = std::array{
      Param<Self>{"D1", &Self::D1, "", "strain at fracture for large tension", Rule::any},
      Param<Self>{"D2", &Self::D2, "", "factor of the triaxiality", Rule::any},
      Param<Self>{"D3", &Self::D3, "",
                  "exponent of the triaxiality s*, tension positive; mostly negative", Rule::any},
      Param<Self>{"D4", &Self::D4, "", "factor of the rate", Rule::any, 0.0},
      Param<Self>{"D5", &Self::D5, "", "factor of the temperature T*", Rule::any, 0.0},
      Param<Self>{"rate0", &Self::rate0, "1/s", "reference rate; slower ones count as this",
                  Rule::positive, 1.0},
  };
  static constexpr auto state_columns = std::array{StateColumn{"damage", "1"}};
  template <class T, int D>
  struct State {
    T damage;
  };
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {T(0.0)};
  }

  void prepare(double) {}
  std::string problem() const { return {}; }

  /// May be negative, where the constants do not hold.
  template <Real T>
  MPM_HD T fracture_strain(T triaxiality, T rate, T temperature) const {
    // e^50 stands for infinity: without a deviator there is no flow either.
    const T held = min(triaxiality, T(largest_triaxiality));
    const T exponent = min(max(T(D3) * held, T(-50.0)), T(50.0));
    return (T(D1) + T(D2) * exp(exponent)) *
           (T(1.0) + T(D4) * log(max(rate * T(1.0 / rate0), T(1.0)))) *
           (T(1.0) + T(D5) * temperature);
  }

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>& state) const {
    const T mean = T(1.0 / 3.0) * trace(at.stress);
    const T triaxiality = mean / max(von_mises(at.stress), T(tiny));
    const T rate = at.plastic_increment * T(1.0 / at.time_step);
    const T strain = fracture_strain(triaxiality, rate, at.temperature);
    const T more = select(strain > T(0.0), at.plastic_increment / max(strain, T(tiny)), T(0.0));
    state.damage = min(state.damage + more, T(1.0));
    return state.damage;
  }
};

}  // namespace mpm
