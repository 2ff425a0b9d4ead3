// A material made from names and numbers: every mistake is one sentence that names the parameter.
#include <cmath>
#include <limits>

#include "check.hpp"
#include "example.hpp"
#include "mpm/materials/material.hpp"

namespace {

using namespace mpm;
using Parameters = std::map<std::string, double>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A choice with one model of a kind; the other parts are such as go with it.
template <class Model>
MaterialChoice choice_of(const Parameters& parameters, double density = 1000.0) {
  const std::string name(Model::name);
  MaterialChoice choice{density, {name, parameters}, {}, {}};
  if constexpr (StrengthModel<Model>) {
    if (Model::eos == EosUse::must) choice.eos = ModelChoice{"linear", {{"K", 1e9}}};
  } else {
    choice.strength = {"j2", {{"E", 1e9}, {"nu", 0.3}, {"Y0", 1e6}}};
    choice.eos = ModelChoice{"linear", {{"K", 1e9}}};
    if constexpr (EosModel<Model>)
      choice.eos = ModelChoice{name, parameters};
    else
      choice.failures = {{{name, parameters}, "no_tension"}};
  }
  return choice;
}

/// For every parameter of every model: missing, not finite, against its rule, and one name too
/// many.
template <class Model>
void check_model(mpm::testing::Report& report, const Model&) {
  const std::string name(Model::name);
  Parameters good;
  for (const auto& p : Model::params)
    good[std::string(p.name)] = mpm::testing::example_value(p.name, p.unit, p.rule);
  if (good.contains("q_psi")) good["q_psi"] = 0.3;
  const auto make = [&](const Parameters& parameters) {
    return make_material(choice_of<Model>(parameters));
  };
  CHECK_EQUAL(make(good).density, 1000.0);

  for (const auto& p : Model::params) {
    const std::string key(p.name), where = name + "." + key;
    if (std::isnan(p.start)) {
      Parameters missing = good;
      missing.erase(key);
      CHECK(mpm::testing::throws([&] { make(missing); }, where), where);
    }
    for (const double value : {infinity, -infinity, std::nan("")}) {
      Parameters bad = good;
      bad[key] = value;
      CHECK(mpm::testing::throws([&] { make(bad); }, where), where, value);
    }
    Parameters bad = good;
    bad[key] = -1.0;
    const bool allowed = p.rule.allows(-1.0);
    const bool refused = mpm::testing::throws([&] { make(bad); }, p.rule.text());
    CHECK(refused != allowed, where);
  }
  Parameters strange = good;
  strange["no_such_parameter"] = 1.0;
  CHECK_THROWS(make(strange), "no parameter no_such_parameter");
  for (const double density : {0.0, -1.0, infinity})
    CHECK(mpm::testing::throws([&] { make_material(choice_of<Model>(good, density)); }, "density"),
          density);
}

/// Models that do not go together, and parameters that do not.
void check_composition(mpm::testing::Report& report) {
  const ModelChoice rubber{"neo_hookean", {{"K", 1e8}, {"G", 1e7}}}, water{"fluid", {}};
  const ModelChoice linear{"linear", {{"K", 1e9}}};
  CHECK_THROWS(make_material({1e3, water, {}, {}}), "give the material an eos");
  CHECK_THROWS(make_material({1e3, rubber, linear, {}}), "takes no eos");
  CHECK_THROWS(
      make_material({1e3, rubber, {}, {{{"plastic_strain", {{"limit", 1.0}}}, "no_shear"}}}),
      "needs a plastic strain");
  CHECK_THROWS(make_material({1e3, water, ModelChoice{"jelly", {}}, {}}), "no eos model");
  const ModelChoice metal{"j2", {{"E", 1e9}, {"nu", 0.3}, {"Y0", 1e6}}};
  CHECK_THROWS(make_material({1e3, metal, {}, {{{"plastic_strain", {{"limit", 1.0}}}, "melt"}}}),
               "failure.action");
  CHECK_THROWS(make_material({1e3, metal, {}, {{{"jelly", {}}, "no_shear"}}}), "no failure model");
  Parameters cold{{"E", 1e11}, {"nu", 0.3}, {"A", 1e8},  {"B", 1e8},       {"n", 0.3},
                  {"C", 0.01}, {"m", 1.0},  {"cp", 400}, {"T_melt", 298.0}};
  CHECK_THROWS(make_material({1e3, {"johnson_cook", cold}, {}, {}}), "T_melt must be > T_room");
  CHECK_THROWS(
      make_material({1e3, water, ModelChoice{"ideal_gas", {{"gamma", 1.0}, {"E0", 1.0}}}, {}}),
      "gamma must be > 1");
}

}  // namespace

void test_material(mpm::testing::Report& report) {
  const auto check = [&](const auto& model) { check_model(report, model); };
  StrengthModels::for_each(check);
  EosModels::for_each(check);
  FailureModels::for_each(check);
  check_composition(report);
  CHECK_THROWS(make_material({1.0, {"jelly", {}}, {}, {}}), "jelly");
  CHECK(Rule::not_negative.allows(0.0) && !Rule::positive.allows(0.0));
  CHECK(!Rule::poisson_ratio.allows(0.5) && !Rule::poisson_ratio.allows(-1.0));
  CHECK(Rule::poisson_ratio.allows(0.4999) && Rule::any.allows(-7.0));
}
