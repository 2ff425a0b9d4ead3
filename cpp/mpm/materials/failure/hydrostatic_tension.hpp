#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Spall: fails at a given mean stress, tension positive.
struct HydrostaticTensionLimit {
  static constexpr std::string_view name = "hydrostatic_tension";
  static constexpr std::string_view doc =
      "spall, fails when the mean stress, tension positive (minus the pressure), reaches limit";
  static constexpr std::string_view source = "Meyers 1994, sec. 16.8";

  double limit{};

  static constexpr auto params = std::array{
      Param<HydrostaticTensionLimit>{"limit", &HydrostaticTensionLimit::limit, "Pa",
                                     "mean stress in tension", Rule::positive},
  };
  static constexpr std::array<StateColumn, 0> state_columns{};
  template <class T, int D>
  using State = NoState<T, D>;
  template <class T, int D>
  State<T, D> start() const {
    return {};
  }

  void prepare(double) {}
  std::string problem() const { return {}; }

  template <Real T, int D>
  T damage(const Condition<T, D>& at, State<T, D>&) const {
    return trace(at.stress) * T(1.0 / (3.0 * limit));
  }
};

}  // namespace mpm
