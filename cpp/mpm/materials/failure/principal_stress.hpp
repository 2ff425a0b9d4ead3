#pragma once
#include <array>

#include "mpm/materials/model.hpp"
#include "mpm/math/eigen.hpp"

namespace mpm {

/// Fails at a given largest principal stress, tension positive.
struct PrincipalStressLimit {
  static constexpr std::string_view name = "principal_stress";
  static constexpr std::string_view doc =
      "fails when the largest principal stress, tension positive, reaches limit";
  static constexpr std::string_view source = "Rankine 1857";

  double limit{};

  static constexpr auto params = std::array{
      Param<PrincipalStressLimit>{"limit", &PrincipalStressLimit::limit, "Pa",
                                  "principal stress in tension", Rule::positive},
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
    const Eigen<T, D> e = eigen(at.stress);
    return max(max(e.value[0], e.value[1]), e.value[2]) * T(1.0 / limit);
  }
};

}  // namespace mpm
