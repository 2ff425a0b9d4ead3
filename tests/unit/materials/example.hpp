#pragma once
// A model of the catalogue with sensible parameters.
#include "mpm/materials/model.hpp"

namespace mpm::testing {

/// A yield stress that nothing here reaches, as large as the moduli, and one that soon is.
inline constexpr double hard = 1e8, soft = 1e5;

/// Moduli of 1e8, stresses of `yield`, ratios of 0.3, exponents and the like 1; what must be
/// larger, larger.
inline double example_value(std::string_view name, std::string_view unit, Rule rule,
                            double yield = hard) {
  if (unit == "J/kg") return name == "e_cv" ? 3e5 : 1e5;
  if (name == "T_melt") return 1000.0;
  if (name == "gamma") return 1.4;
  if (name == "q_phi") return 0.5;
  if (name == "n" || name == "e0") return 0.5;
  if (unit == "rad") return 0.5;
  if (unit == "Pa") return name == "E" || name == "K" || name == "G" ? 1e8 : yield;
  if (rule == Rule::poisson_ratio) return 0.3;
  if (unit == "m/s") return 300.0;
  return unit.empty() || unit == "1/s" ? 1.0 : 300.0;
}

template <class Model>
Model example(double yield = hard) {
  Model model;
  for (const auto& p : Model::params)
    model.*p.member = example_value(p.name, p.unit, p.rule, yield);
  if constexpr (requires { model.q_psi; }) model.q_psi = 0.3;
  model.prepare(1000.0);
  return model;
}

}  // namespace mpm::testing
