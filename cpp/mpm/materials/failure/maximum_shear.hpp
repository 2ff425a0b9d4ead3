#pragma once
#include "mpm/materials/one_limit.hpp"
#include "mpm/math/eigen.hpp"

namespace mpm {

/// Fails at a given largest shear stress.
struct MaximumShearLimit : OneLimit {
  static constexpr std::string_view name = "maximum_shear";
  static constexpr std::string_view doc =
      "fails when the largest shear stress, half the difference of the largest and the smallest "
      "principal stress, reaches limit";
  static constexpr std::string_view source = "Tresca 1864";

  static constexpr auto params = one_limit("Pa", "largest shear stress");

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>&) const {
    const Eigen<T, D> e = eigen(at.stress);
    const T largest = max(max(e.value[0], e.value[1]), e.value[2]);
    const T smallest = min(min(e.value[0], e.value[1]), e.value[2]);
    return (largest - smallest) * T(0.5 / limit);
  }
};

}  // namespace mpm
