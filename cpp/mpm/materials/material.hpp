#pragma once
// A material: an initial density, one strength model, at most one equation of state and any number
// of failure models, composed at run time.
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mpm/catalogue/setting.hpp"
#include "mpm/catalogue/words.hpp"
#include "mpm/materials/catalogue.hpp"

namespace mpm {

/// What becomes of a particle that has failed. Ordered: of two, the greater is done.
enum class FailureAction {
  intact = 0,
  no_shear = 1,    // the deviator is dropped, the pressure kept
  no_tension = 2,  // the deviator is dropped, the mean stress kept where it is compression
  erode = 3,       // all stress is dropped, and the particle takes no part from the next step on
};
template <>
inline constexpr auto words<FailureAction> = std::to_array<Word<FailureAction>>(
    {{"no_tension", FailureAction::no_tension, "the particle bears compression only (the default)"},
     {"no_shear", FailureAction::no_shear, "it keeps its whole pressure, like a liquid"},
     {"erode", FailureAction::erode,
      "it takes no part any more; the ledger keeps its energy in `eroded`"}});

/// A failure model and what it does.
struct Failing {
  FailureModels::Any model;
  FailureAction action;
};

/// Artificial bulk viscosity (von Neumann & Richtmyer 1950, with Landshoff's linear term):
/// q = rho h^2 quadratic e^2 - rho h c linear e for a rate of volume change e < 0.
struct BulkViscosity {
  double quadratic = 1.5, linear = 0.06;

  static constexpr std::string_view table = "run.viscosity";
  using Self = BulkViscosity;
  static constexpr auto settings = std::tuple{
      Setting{"quadratic", &Self::quadratic, "factor of the term that spreads shocks over cells",
              Rule::not_negative},
      Setting{"linear", &Self::linear, "factor of the term that damps the ringing behind them",
              Rule::not_negative}};
  MPM_HD bool active() const { return quadratic > 0.0 || linear > 0.0; }
};

/// Damping in proportion to the stiffness, Rayleigh's beta: beside the stress of the models, and no
/// part of it, acts beta C : D, with the rate of strain D and the elastic moduli C of the start; on
/// the change of shape alone where volumes are averaged, which particles do not have by themselves.
struct StiffnessDamping {
  double beta = 0.0;                   // [s]
  double pressure = 0.0, shear = 0.0;  // moduli rho c^2 of both waves, as damped [Pa]
  bool of_shape = false;

  MPM_HD bool active() const { return beta > 0.0; }
};

/// What an equation of state must not exceed. The pressure of a solid is linear in its energy also
/// where a particle is debris of many times its volume, most of which is void; there an energy
/// below zero pulls the void shut, which lowers the energy further.
struct EosBounds {
  double lowest_energy = -unbounded;  // at absolute zero [J/m^3 of initial volume]
  double tension = unbounded;         // spall strength [Pa]
  bool active = false;

  /// Is a mean stress that limit, as far as it may have been rounded to a float?
  template <class T>
  MPM_HD auto limits(T mean_stress) const {
    return mean_stress >= T(tension * (1.0 - 1e-6));
  }

  // Out of line: bounds act seldom, and what is not there neither slows nor rounds the rest.

  /// The energy without the work that tension at its limit has done on a change of volume: that
  /// opens voids between fragments, and heats nothing.
  template <class T>
  MPM_COLD MPM_HD T without_voids(T energy, T mean_stress, T change) const {
    return energy - select(limits(mean_stress), T(0.5) * mean_stress * change, T(0.0));
  }
  /// The pressure within the bounds; `energy` is that of the end but for the new pressure's work,
  /// `lowest` the pressure about the lowest energy.
  template <class T>
  MPM_COLD MPM_HD T held(T pressure, T energy, T change, LinearInEnergy<T> lowest) const {
    const auto below = energy - T(0.5) * pressure * change < T(lowest_energy);
    // What has no heat left bears no tension: it would be given energy in every step in which it is
    // torn, again and again.
    const T coldest = max(lowest.pressure(T(lowest_energy)), T(0.0));
    return max(select(below, coldest, pressure), T(-tension));
  }
};

/// What matter is to others that touch it: a solid, whose surface keeps its particles; a liquid, of
/// which others become the surface; a gas, products of an explosive too, which has none.
enum class Matter : std::uint8_t { solid, liquid, gas };
inline constexpr const char* matter_names[] = {"solid", "liquid", "gas"};

struct Material {
  double density = 0.0;  // initial [kg/m^3]
  StrengthModels::Any strength;
  std::optional<EosModels::Any> eos;
  std::vector<Failing> failures;
  BulkViscosity viscosity{0.0, 0.0};  // none
  StiffnessDamping damping{};         // none
  EosBounds bounds{};
  // Over a cell's particles (step/volume_averaging.hpp); of bodies on nodes of their own their
  // pressures (step/average_in_body.cpp), or only once a body flows.
  bool averages_volume = false, averages_once_it_flows = false;

  bool moves_as_one() const {
    return std::visit([]<class M>(const M&) { return requires { M::moves_as_one; }; }, strength);
  }
  bool burns() const {
    return std::visit([]<class M>(const M&) { return Burns<M>; }, strength);
  }
  bool damps() const {
    return std::visit([]<class M>(const M&) { return Damps<M>; }, strength);
  }
  /// Does it flow plastically, and keep how far?
  bool yields() const {
    return std::visit(
        []<class M>(const M&) {
          return requires(typename M::template State<double, 3> s) { s.plastic_strain; };
        },
        strength);
  }
  /// Has it no shape of its own?
  bool flows() const {
    return std::visit([]<class M>(const M&) { return requires { M::flows; }; }, strength);
  }
  /// Are neighbours no neighbours for long: as it flows, is loose or spalls?
  bool is_loose() const {
    return flows() || bounds.tension < unbounded ||
           std::visit([]<class M>(const M&) { return requires { M::breaks_up; }; }, strength);
  }
  /// May its particles part: as it is loose or can fail?
  bool breaks_up() const { return is_loose() || !failures.empty(); }
  /// A gas fills any volume, and so do products of detonation.
  Matter matter() const {
    if (!flows()) return Matter::solid;
    const bool gas = eos && std::visit([](const auto& model) { return model.is_gas(); }, *eos);
    return gas ? Matter::gas : Matter::liquid;
  }
  bool erodes() const { return does(FailureAction::erode); }
  /// May failure do that?
  bool does(FailureAction action) const {
    return std::any_of(failures.begin(), failures.end(),
                       [&](const Failing& f) { return f.action == action; });
  }
};

/// Shear modulus at small strain [Pa]; 0 of what resists no shear.
double shear_modulus(const Material& material);

/// A model as the user gives it: a name and numbers in SI units.
struct ModelChoice {
  std::string name;
  std::map<std::string, double> parameters;
};
struct FailureChoice {
  ModelChoice model;
  std::string action;  // "no_shear", "no_tension" or "erode"
};
struct MaterialChoice {
  double density = 0.0;
  ModelChoice strength;
  std::optional<ModelChoice> eos;
  std::vector<FailureChoice> failures;
  BulkViscosity viscosity{0.0, 0.0};  // none
  double damping = 0.0;               // beta [s]
  // If nothing is said, of bodies on nodes of their own that flow plastically, once they do.
  std::optional<bool> volume_averaging = false;
  bool in_body = false;  // of bodies on nodes of their own
};

/// Throws std::invalid_argument, in one sentence, for an unknown model or parameter, one that is
/// missing, a value its rule forbids, or models that do not go together.
Material make_material(const MaterialChoice& choice);

}  // namespace mpm
