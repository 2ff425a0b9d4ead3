#include "mpm/materials/material.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "mpm/materials/material_block.hpp"

namespace mpm {
namespace {

[[noreturn]] void refuse(const std::string& key, double value, std::string_view rule) {
  std::ostringstream text;
  text << key << " = " << value << ' ' << rule;
  throw std::invalid_argument(text.str());
}

template <class Model>
void set_parameters(Model& model, const std::map<std::string, double>& parameters) {
  std::size_t used = 0;
  for (const auto& p : Model::params) {
    const std::string key = std::string(Model::name) + "." + std::string(p.name);
    const auto given = parameters.find(std::string(p.name));
    if (given == parameters.end() && std::isnan(p.start))
      throw std::invalid_argument(key + " (" + std::string(p.meaning) + ") is missing");
    const double value = given == parameters.end() ? p.start : given->second;
    if (!p.rule.allows(value)) refuse(key, value, p.rule.text());
    model.*p.member = value;
    used += given != parameters.end();
  }
  if (used == parameters.size()) return;
  for (const auto& [name, value] : parameters) {
    bool known = false;
    for (const auto& p : Model::params) known = known || p.name == name;
    if (!known) throw std::invalid_argument(std::string(Model::name) + " has no parameter " + name);
  }
}

/// The model of a catalogue that the user has chosen, with its parameters.
template <class Models>
typename Models::Any made(const char* kind, const ModelChoice& choice, double density) {
  std::optional<typename Models::Any> found;
  Models::for_each([&](auto model) {
    if (model.name != choice.name) return;
    set_parameters(model, choice.parameters);
    if (const std::string problem = model.problem(); !problem.empty())
      throw std::invalid_argument(problem);
    model.prepare(density);
    found = model;
  });
  if (!found)
    throw std::invalid_argument("no " + std::string(kind) + " model is named " + choice.name);
  return *found;
}

/// Has the strength model what the failure model judges by?
template <class Strength, class Failure>
void check_together(const Strength& strength, const Failure& failure, bool has_eos) {
  using State = typename Strength::template State<double, 3>;
  const std::string name(failure.name), with(strength.name);
  if constexpr (Failure::needs_plasticity)
    if (!requires(State s) { s.plastic_strain; })
      throw std::invalid_argument("failure." + name + " needs a plastic strain, which " + with +
                                  " does not have");
  if constexpr (Failure::needs_energy)
    if (!has_eos)
      throw std::invalid_argument("failure." + name + " needs an internal energy: give an eos");
}

/// The heat that a material holds at the start [J per initial volume]: with a constant specific
/// heat, which is more than there is, as it goes to zero with the temperature (Debye 1912);
/// infinite where the strength model has none.
double heat_at_start(const Material& material) {
  return std::visit(
      [&]<class M>(const M& model) {
        if constexpr (requires { model.cp * model.T0; })
          return material.density * model.cp * model.T0;
        else
          return unbounded;
      },
      material.strength);
}

EosBounds bounds_of(const Material& material) {
  if (!material.eos) return {};
  return std::visit(
      [&]<class M>(const M& model) {
        EosBounds bounds{.lowest_energy = model.energy_at_zero(heat_at_start(material))};
        if constexpr (requires { model.spall_strength; })
          if (model.spall_strength > 0.0) bounds.tension = model.spall_strength;
        bounds.active = std::isfinite(bounds.lowest_energy) || std::isfinite(bounds.tension);
        return bounds;
      },
      *material.eos);
}

}  // namespace

double shear_modulus(const Material& material) {
  return std::visit(
      []<class M>(const M& model) {
        if constexpr (requires { model.elastic.G; })
          return model.elastic.G;
        else if constexpr (requires { model.G; })
          return model.G;
        else
          return 0.0;
      },
      material.strength);
}

namespace {

void choose_averaging(Material& material, const MaterialChoice& choice) {
  const bool wanted = choice.volume_averaging.value_or(false);
  if (wanted && material.moves_as_one())
    throw std::invalid_argument(choice.strength.name +
                                " does not deform and takes no volume_averaging");
  if (wanted && material.burns())
    throw std::invalid_argument(choice.strength.name +
                                " takes no volume_averaging: its front is sharper than a cell");
  material.averages_volume = wanted;
  if (choice.volume_averaging || !choice.in_body) return;
  material.averages_volume = material.averages_once_it_flows = material.yields();
}

}  // namespace

Material make_material(const MaterialChoice& choice) {
  if (!Rule::positive.allows(choice.density))
    refuse("density", choice.density, Rule::positive.text());
  Material material;
  material.density = choice.density;
  material.strength = made<StrengthModels>("strength", choice.strength, choice.density);
  if (choice.eos) material.eos = made<EosModels>("eos", *choice.eos, choice.density);
  std::visit(
      [&](const auto& strength) {
        const std::string name(strength.name);
        if (strength.eos == EosUse::must && !material.eos)
          throw std::invalid_argument(name +
                                      " has no pressure of its own: give the material an eos");
        if (strength.eos == EosUse::never && material.eos)
          throw std::invalid_argument(name + " gives the whole stress and takes no eos");
        if (material.moves_as_one() && !choice.failures.empty())
          throw std::invalid_argument(name + " has no stress and takes no failure model");
        for (const FailureChoice& failure : choice.failures) {
          const auto model = made<FailureModels>("failure", failure.model, choice.density);
          std::visit([&](const auto& m) { check_together(strength, m, material.eos.has_value()); },
                     model);
          material.failures.push_back(
              {model, choice_named<FailureAction>("failure.action", failure.action)});
        }
      },
      material.strength);
  for_each_setting<BulkViscosity>([&](const auto& row) {
    const double factor = choice.viscosity.*row.member;
    if (!row.rule.allows(factor)) refuse("viscosity", factor, row.rule.text());
  });
  material.viscosity = choice.viscosity;
  material.bounds = bounds_of(material);
  choose_averaging(material, choice);
  if (!Rule::not_negative.allows(choice.damping))
    refuse("damping.stiffness", choice.damping, Rule::not_negative.text());
  if (choice.damping > 0.0) {
    if (material.moves_as_one())
      throw std::invalid_argument("a material without stress takes no damping.stiffness");
    const double c = sound_speed_at_start(material), G = shear_modulus(material);
    // In space particles have no change of volume of their own then.
    const bool of_shape = material.averages_volume && !choice.in_body;
    if (of_shape && !(G > 0.0))
      throw std::invalid_argument(
          "a fluid with volume_averaging takes no damping.stiffness, which is of its shape then");
    const double pressure = of_shape ? 4.0 / 3.0 * G : material.density * c * c;
    material.damping = {choice.damping, pressure, G, of_shape};
  }
  return material;
}

}  // namespace mpm
