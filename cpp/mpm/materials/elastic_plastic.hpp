#pragma once
// What models share that are elastic up to yielding.
#include <array>

#include "mpm/materials/radial_return.hpp"
#include "mpm/materials/strength/elastic.hpp"

namespace mpm {

/// State of a plastic model without temperature.
template <class T, int D>
struct PlasticState {
  T plastic_strain;  // equivalent
};

/// Base of a model that is elastic up to yielding. The model adds its parameters, among them E and
/// nu, and an `update` that begins with `elastic.update(motion, stress)`; names of the base that it
/// has too replace those below.
template <class Model>
struct ElasticPlastic {
  static constexpr EosUse eos = EosUse::may;
  static constexpr bool by_rates = true;

  Elastic elastic{};

  static constexpr auto state_columns = std::array{StateColumn{"plastic_strain", "1"}};
  template <class T, int D>
  using State = PlasticState<T, D>;
  template <class T, int D>
  MPM_HD PlasticState<T, D> start() const {
    return {T(0.0)};
  }

  void prepare(double density) {
    const Model& model = static_cast<const Model&>(*this);
    elastic = Elastic::of(model.E, model.nu, density);
  }
  std::string problem() const { return {}; }

  template <Real T, int D>
  MPM_HD T sound_speed(const Sym<T, D>&, const auto& /*state*/, T J) const {
    return elastic.sound_speed(J);
  }
  template <Real T>
  MPM_HD T other_speed_squared(const auto& /*state*/, T J) const {
    return elastic.other_speed_squared(J);
  }
};

/// Base of a model that yields at von Mises' stress Y(ep), ep the equivalent plastic strain: the
/// model adds `yield(ep)`, which gives Y and dY/dep.
template <class Model>
struct MisesPlastic : ElasticPlastic<Model> {
  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  PlasticState<T, D>& state) const {
    this->elastic.update(motion, stress);
    const Model& model = static_cast<const Model&>(*this);
    const T before = state.plastic_strain, static_yield = model.yield(before).value;
    const auto done = return_radially(stress, this->elastic.G, static_yield,
                                      [&](T d) { return model.yield(before + d); });
    state.plastic_strain += done.increment;
    return T(0.5) * (static_yield + done.von_mises) * done.increment;
  }
};

}  // namespace mpm
