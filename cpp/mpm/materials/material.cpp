#include "mpm/materials/material.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

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
    if (!satisfies(p.rule, value)) refuse(key, value, rule_text(p.rule));
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

}  // namespace

std::string_view rule_text(Rule rule) {
  switch (rule) {
    case Rule::positive:
      return "must be > 0";
    case Rule::not_negative:
      return "must be >= 0";
    case Rule::poisson_ratio:
      return "must lie between -1 and 0.5, both excluded";
    case Rule::any:
      break;
  }
  return "must be a finite number";
}

bool satisfies(Rule rule, double value) {
  if (!std::isfinite(value)) return false;
  switch (rule) {
    case Rule::positive:
      return value > 0.0;
    case Rule::not_negative:
      return value >= 0.0;
    case Rule::poisson_ratio:
      return value > -1.0 && value < 0.5;
    case Rule::any:
      break;
  }
  return true;
}

Material make_material(double density, const std::string& strength,
                       const std::map<std::string, double>& parameters) {
  if (!satisfies(Rule::positive, density)) refuse("density", density, rule_text(Rule::positive));
  Material material;
  material.density = density;
  bool found = false;
  StrengthModels::for_each([&](auto model) {
    if (model.name != strength) return;
    set_parameters(model, parameters);
    model.prepare(density);
    material.strength = model;
    found = true;
  });
  if (!found) throw std::invalid_argument("no strength model is named " + strength);
  return material;
}

}  // namespace mpm
