#pragma once
#include <array>

#include "mpm/materials/jaumann.hpp"
#include "mpm/materials/one_limit.hpp"
#include "mpm/math/eigen.hpp"

namespace mpm {

/// Fails at a given largest principal strain, extension positive. The strain is summed in the frame
/// that turns with the particle (Jaumann), as the stress of `elastic` is: logarithmic where the
/// axes do not turn in the material.
struct PrincipalStrainLimit : OneLimit {
  static constexpr std::string_view name = "principal_strain";
  static constexpr std::string_view doc =
      "fails when the largest principal strain, extension positive, reaches limit; the strain is "
      "logarithmic, summed in the frame that turns with the particle";
  static constexpr std::string_view source = "Saint-Venant 1870; summed after Hughes & Winget 1980";

  static constexpr auto params = one_limit("", "principal strain in extension");
  static constexpr auto state_columns = std::array{StateColumn{"strain", "1", Shape::symmetric}};
  template <class T, int D>
  struct State {
    Sym<T, D> strain;
  };
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {Sym<T, D>::zero()};
  }

  template <Real T, int D>
  MPM_HD T damage(const Condition<T, D>& at, State<T, D>& state) const {
    StrainIncrement<T, D> motion{};
    motion.gradient = at.gradient;
    const Corotated<T, D> turned = corotate(motion, state.strain);
    state.strain = turned.stress + turned.strain;
    const Eigen<T, D> e = eigen(state.strain);
    return max(max(e.value[0], e.value[1]), e.value[2]) * T(1.0 / limit);
  }
};

}  // namespace mpm
