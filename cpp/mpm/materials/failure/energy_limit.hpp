#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Fails at a given internal energy.
struct EnergyLimit {
  static constexpr std::string_view name = "energy_limit";
  static constexpr std::string_view doc =
      "fails when the internal energy per initial volume, at the start of the step, reaches limit";
  static constexpr std::string_view source = "the definition of the internal energy";
  static constexpr bool needs_energy = true;

  double limit{};

  static constexpr auto params = std::array{
      Param<EnergyLimit>{"limit", &EnergyLimit::limit, "J/m^3",
                         "internal energy per initial volume", Rule::positive},
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
    return at.energy * T(1.0 / limit);
  }
};

}  // namespace mpm
