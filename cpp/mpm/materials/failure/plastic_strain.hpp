#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Fails at a given equivalent plastic strain.
struct PlasticStrainLimit {
  static constexpr std::string_view name = "plastic_strain";
  static constexpr std::string_view doc = "fails when the equivalent plastic strain reaches limit";
  static constexpr std::string_view source = "Ma, Zhang & Huang 2010, sec. 3.2";
  static constexpr bool needs_plasticity = true;

  double limit{};

  static constexpr auto params = std::array{
      Param<PlasticStrainLimit>{"limit", &PlasticStrainLimit::limit, "",
                                "equivalent plastic strain", Rule::positive},
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
    return at.plastic_strain * T(1.0 / limit);
  }
};

}  // namespace mpm
