#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// High explosive with programmed burn: the pressure of the EOS times the burn fraction
/// F = (t - t_l) D / (1.5 h) between 0 and 1, t_l the time at which the detonation arrives, D its
/// speed and h the cell size (Wilkins 1964; the factor 1.5 after Hallquist 2006, sec. 19.8).
struct HighExplosive {
  static constexpr std::string_view name = "high_explosive";
  static constexpr std::string_view doc =
      "high explosive with programmed burn: the pressure of the EOS times the burn fraction, which "
      "rises from 0 to 1 over one and a half cells behind a front of speed D from the nearest "
      "[[detonation]] point; no strength";
  static constexpr std::string_view source =
      "Wilkins 1964; Hallquist 2006 (LS-DYNA theory manual), sec. 19.8";
  static constexpr EosUse eos = EosUse::must;
  static constexpr bool flows = true;
  static constexpr double width = 1.5;   // of the front [cells]
  static constexpr double never = 1e30;  // [s]

  double D_front{};

  static constexpr auto params = std::array{
      Param<HighExplosive>{"D", &HighExplosive::D_front, "m/s", "speed of detonation",
                           Rule::positive},
  };
  static constexpr auto state_columns =
      std::array{StateColumn{"lighting_time", "s"}, StateColumn{"burn_fraction", "1"}};
  template <class T, int D>
  struct State {
    T lighting_time, burn_fraction;
  };
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {T(never), T(0.0)};
  }

  void prepare(double) {}
  std::string problem() const { return {}; }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    const T gone = (T(motion.time) - state.lighting_time) * T(D_front / (width * motion.cell_size));
    state.burn_fraction = max(state.burn_fraction, min(gone, T(1.0)));
    stress = Sym<T, D>::zero();
    return T(0.0);
  }

  /// Until it burns, the front is what must not pass a cell within a step.
  template <Real T, int D>
  MPM_HD T other_speed_squared(const State<T, D>& state, T) const {
    return (T(1.0) - state.burn_fraction) * T(D_front * D_front);
  }
};

}  // namespace mpm
