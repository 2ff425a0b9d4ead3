// A material made from names and numbers: every mistake is one sentence that names the parameter.
#include <cmath>
#include <limits>

#include "check.hpp"
#include "mpm/materials/material.hpp"

namespace {

using namespace mpm;
using Parameters = std::map<std::string, double>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// For every parameter of every model: missing, not finite, against its rule, and one name too
/// many.
template <class Model>
void check_model(mpm::testing::Report& report, const Model&) {
  const std::string name(Model::name);
  Parameters good;
  for (const auto& p : Model::params)
    good[std::string(p.name)] = p.rule == Rule::poisson_ratio ? 0.3 : 1.0;
  const Material material = make_material(1000.0, name, good);
  CHECK_EQUAL(material.density, 1000.0);
  CHECK(std::holds_alternative<Model>(material.strength), name);

  for (const auto& p : Model::params) {
    const std::string key(p.name), where = name + "." + key;
    if (std::isnan(p.start)) {
      Parameters missing = good;
      missing.erase(key);
      CHECK(mpm::testing::throws([&] { make_material(1.0, name, missing); }, where), where);
    }
    for (const double value : {infinity, -infinity, std::nan("")}) {
      Parameters bad = good;
      bad[key] = value;
      CHECK(mpm::testing::throws([&] { make_material(1.0, name, bad); }, where), where, value);
    }
    Parameters bad = good;
    bad[key] = -1.0;
    const bool allowed = satisfies(p.rule, -1.0);
    const bool refused =
        mpm::testing::throws([&] { make_material(1.0, name, bad); }, rule_text(p.rule));
    CHECK(refused != allowed, where);
  }
  Parameters strange = good;
  strange["no_such_parameter"] = 1.0;
  CHECK_THROWS(make_material(1.0, name, strange), "no parameter no_such_parameter");
  for (const double density : {0.0, -1.0, infinity})
    CHECK(mpm::testing::throws([&] { make_material(density, name, good); }, "density"), density);
}

}  // namespace

void test_material(mpm::testing::Report& report) {
  StrengthModels::for_each([&](const auto& model) { check_model(report, model); });
  CHECK_THROWS(make_material(1.0, "jelly", {}), "jelly");
  CHECK(satisfies(Rule::not_negative, 0.0) && !satisfies(Rule::positive, 0.0));
  CHECK(!satisfies(Rule::poisson_ratio, 0.5) && !satisfies(Rule::poisson_ratio, -1.0));
  CHECK(satisfies(Rule::poisson_ratio, 0.4999) && satisfies(Rule::any, -7.0));
}
