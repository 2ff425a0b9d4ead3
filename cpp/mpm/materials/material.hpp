#pragma once
// A material: an initial density and a strength model, composed at run time.
#include <map>
#include <string>

#include "mpm/materials/catalogue.hpp"

namespace mpm {

struct Material {
  double density = 0.0;  // initial [kg/m^3]
  StrengthModels::Any strength;
};

/// A material from names and numbers in SI units; throws std::invalid_argument, in one sentence,
/// for an unknown model or parameter, one that is missing, or a value its rule forbids.
Material make_material(double density, const std::string& strength,
                       const std::map<std::string, double>& parameters);

/// What a rule demands, in words: "must be > 0".
std::string_view rule_text(Rule rule);
bool satisfies(Rule rule, double value);

}  // namespace mpm
