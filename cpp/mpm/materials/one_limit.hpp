#pragma once
// What failure models share that have one limit.
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// Base of a failure model with the one parameter `limit` and no state. The model adds `params`, by
/// `one_limit`, and `damage`; names of the base that it has too replace those below.
struct OneLimit {
  static constexpr bool needs_plasticity = false, needs_energy = false;

  double limit{};

  static constexpr std::array<StateColumn, 0> state_columns{};
  template <class T, int D>
  using State = NoState<T, D>;
  template <class T, int D>
  MPM_HD NoState<T, D> start() const {
    return {};
  }

  void prepare(double) {}
  std::string problem() const { return {}; }
};

constexpr std::array<Param<OneLimit>, 1> one_limit(std::string_view unit,
                                                   std::string_view meaning) {
  return {{{"limit", &OneLimit::limit, unit, meaning, Rule::positive}}};
}

}  // namespace mpm
