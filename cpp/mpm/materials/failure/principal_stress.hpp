#pragma once
#include "mpm/materials/one_limit.hpp"
#include "mpm/math/eigen.hpp"

namespace mpm {

/// Fails at a given largest principal stress, tension positive.
struct PrincipalStressLimit : OneLimit {
  static constexpr std::string_view name = "principal_stress";
  static constexpr std::string_view doc =
      "fails when the largest principal stress, tension positive, reaches limit";
  static constexpr std::string_view source = "Rankine 1857";

  static constexpr auto params = one_limit("Pa", "principal stress in tension");

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>&) const {
    const Eigen<T, D> e = eigen(at.stress);
    return max(max(e.value[0], e.value[1]), e.value[2]) * T(1.0 / limit);
  }
};

}  // namespace mpm
