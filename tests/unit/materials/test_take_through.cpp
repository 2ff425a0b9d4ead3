// A particle by itself, with models and lists as a device has them, gets the bits that it gets in a
// block of the host.
#include <random>

#include "check.hpp"
#include "example.hpp"
#include "mpm/materials/take_through.hpp"
#include "one_point.hpp"

namespace {

using namespace mpm;
using mpm::testing::OnePoint;
using mpm::testing::soft;

template <class M>
ModelChoice soft_choice(const M& model) {
  ModelChoice choice{std::string(model.name), {}};
  for (const auto& p : M::params)
    choice.parameters[std::string(p.name)] =
        mpm::testing::example_value(p.name, p.unit, p.rule, soft);
  return choice;
}

/// Of J2 and a linear equation of state.
template <int D>
void check_way(mpm::testing::Report& report, const MaterialChoice& choice) {
  OnePoint<D> host(choice);
  OnePoint<D, 1> alone(choice);
  const MaterialView view = view_of(alone.material);
  const FailureList failures = list_of(alone.material.failures);
  const BlockColumns<D> columns(alone.columns, alone.at);
  const J2 strength = std::get<J2>(alone.material.strength);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-0.05, 0.05);
  for (int step = 0; step < 40; ++step) {
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        host.block.gradient[i][j][0] = alone.block.gradient[i][j][0] = any(random);
    const StressSettings settings{1e-4, 1e-4 * (step + 1), 0.5, view.viscosity, step % 2 == 0};
    update_block<double, D>(host.material, host.columns, host.at, host.block, settings, host.sums);
    if (const auto& eos = alone.material.eos)
      take_through<double>(view, strength, std::get<LinearBulk>(*eos), failures, columns, settings,
                           alone.block, alone.sums);
    else
      take_through<double>(view, strength, NoEos{}, failures, columns, settings, alone.block,
                           alone.sums);
    for (const ColumnInfo& info : host.columns.infos())
      for (int c = 0; c < info.components; ++c)
        report.check(alone.value(info, c) == host.value(info, c), __FILE__, __LINE__, info.name,
                     "alone, host, step", alone.value(info, c), host.value(info, c), step);
    CHECK_EQUAL(alone.sums.internal, host.sums.internal);
    CHECK_EQUAL(alone.sums.damped, host.sums.damped);
    CHECK_EQUAL(alone.sums.fastest, host.sums.fastest);
    CHECK_EQUAL(alone.sums.eroded, host.sums.eroded);
  }
  CHECK(host.sums.plastic > 0.0, host.sums.plastic);
}

}  // namespace

void test_take_through(mpm::testing::Report& report) {
  const ModelChoice linear{"linear", {{"K", 1e8}}}, strength = soft_choice(J2{});
  const BulkViscosity viscosity{1.5, 0.1};
  const std::vector<FailureChoice> none;
  check_way<2>(report, {1000.0, strength, {}, none, viscosity});
  check_way<3>(report, {1000.0, strength, linear, none, viscosity, 1e-5});
  const FailureChoice first{soft_choice(PlasticStrainLimit{}), "no_shear"};
  FailureModels::for_each([&](const auto& model) {
    check_way<3>(
        report,
        {1000.0, strength, linear, {first, {soft_choice(model), "erode"}}, viscosity, 1e-5});
  });
  const MaterialChoice many{1000.0, strength, linear,
                            std::vector<FailureChoice>(FailureList::most + 1, first), viscosity};
  CHECK_THROWS(list_of(make_material(many).failures), "at most 8 failure models");
}
