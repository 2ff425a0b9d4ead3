#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// A fluid: no strength but Newton's viscous stress 2 mu dev(D). Its pressure is the EOS's.
struct Fluid {
  static constexpr std::string_view name = "fluid";
  static constexpr std::string_view doc =
      "fluid with Newton's viscosity, or none; its pressure comes from an equation of state";
  static constexpr std::string_view source = "Batchelor 1967, eq. 3.3.11";
  static constexpr EosUse eos = EosUse::must;
  static constexpr bool flows = true;

  double viscosity{}, density{};

  static constexpr auto params = std::array{
      Param<Fluid>{"viscosity", &Fluid::viscosity, "Pa*s", "dynamic viscosity", Rule::not_negative,
                   0.0},
  };
  static constexpr std::array<StateColumn, 0> state_columns{};
  template <class T, int D>
  using State = NoState<T, D>;
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {};
  }

  void prepare(double initial_density) { density = initial_density; }
  std::string problem() const { return {}; }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress, State<T, D>&) const {
    const Sym<T, D> strain = symmetric_part(mid_step(motion.gradient));
    const Sym<T, D> shear = strain - Sym<T, D>::isotropic(T(1.0 / 3.0) * trace(strain));
    stress = T(2.0 * viscosity / motion.time_step) * shear;
    return inner(stress, shear);
  }

  template <Real T, int D>
  MPM_HD T other_speed_squared(const State<T, D>&, T) const {
    return T(0.0);
  }
  /// Alone, that is a time step of h^2 / (2 nu 4/3), the limit of diffusion.
  template <Real T>
  MPM_HD T damping_speed(T J, double cell_size) const {
    return T(4.0 / 3.0 * viscosity / (density * cell_size)) * J;
  }
};

}  // namespace mpm
