#pragma once
#include <array>

#include "mpm/materials/radial_return.hpp"
#include "mpm/materials/strength/elastic.hpp"

namespace mpm {

/// Von Mises plasticity with power hardening, Y = Y0 (1 + ep / e0)^n.
struct Swift {
  static constexpr std::string_view name = "swift";
  static constexpr std::string_view doc =
      "von Mises plasticity with power hardening, Y = Y0 (1 + ep/e0)^n";
  static constexpr std::string_view source = "Swift 1952";
  static constexpr EosUse eos = EosUse::may;

  double E{}, nu{}, Y0{}, e0{}, n{};
  Elastic elastic{};

  static constexpr auto params = std::array{
      Param<Swift>{"E", &Swift::E, "Pa", "Young's modulus", Rule::positive},
      Param<Swift>{"nu", &Swift::nu, "", "Poisson's ratio", Rule::poisson_ratio},
      Param<Swift>{"Y0", &Swift::Y0, "Pa", "yield stress in tension at the start", Rule::positive},
      Param<Swift>{"e0", &Swift::e0, "", "reference strain", Rule::positive},
      Param<Swift>{"n", &Swift::n, "", "exponent of hardening", Rule::not_negative},
  };
  static constexpr auto state_columns = plastic_state_columns;
  template <class T, int D>
  using State = PlasticState<T, D>;
  template <class T, int D>
  State<T, D> start() const {
    return {T(0.0)};
  }

  void prepare(double density) { elastic = Elastic::of(E, nu, density); }
  std::string problem() const { return {}; }

  /// Yield stress and its slope at a plastic strain.
  template <Real T>
  Yield<T> yield(T plastic_strain) const {
    const T stretched = T(1.0) + T(1.0 / e0) * plastic_strain;
    const T value = T(Y0) * pow(stretched, T(n));
    return {value, T(n / e0) * value / stretched};
  }

  template <Real T, int D>
  T update(const Motion<T, D>& motion, Sym<T, D>& stress, State<T, D>& state) const {
    elastic.update(motion, stress);
    const T before = state.plastic_strain;
    const auto done = return_radially(stress, elastic.G, yield(before).value,
                                      [&](T d) { return yield(before + d); });
    state.plastic_strain += done.increment;
    return done.von_mises * done.increment;
  }

  template <Real T, int D>
  T sound_speed(const Sym<T, D>&, const State<T, D>&, T J) const {
    return elastic.sound_speed(J);
  }
  template <Real T, int D>
  T shear_wave_squared(const State<T, D>&, T J, double) const {
    return elastic.shear_wave_squared(J);
  }
};

}  // namespace mpm
