#pragma once
#include <array>

#include "mpm/materials/model.hpp"

namespace mpm {

/// A body that does not deform. It has no stress; its particles move as one
/// (step/rigid_bodies.cpp).
struct Rigid {
  static constexpr std::string_view name = "rigid";
  static constexpr std::string_view doc =
      "a body that does not deform: it moves and turns as one under gravity and the forces of the "
      "bodies that touch it; rigid bodies do not feel each other, and a wall holds one that has "
      "reached it";
  static constexpr std::string_view source = "Newton's and Euler's laws";
  static constexpr EosUse eos = EosUse::never;
  static constexpr bool moves_as_one = true;

  static constexpr std::array<Param<Rigid>, 0> params{};
  static constexpr std::array<StateColumn, 0> state_columns{};
  template <class T, int D>
  using State = NoState<T, D>;
  template <class T, int D>
  MPM_HD State<T, D> start() const {
    return {};
  }

  void prepare(double) {}
  std::string problem() const { return {}; }

  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>&, Sym<T, D>&, State<T, D>&) const {
    return T(0.0);
  }
  /// No wave limits the time step.
  template <Real T, int D>
  MPM_HD T sound_speed(const Sym<T, D>&, const State<T, D>&, T) const {
    return T(0.0);
  }
};

}  // namespace mpm
