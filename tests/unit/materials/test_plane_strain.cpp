// A point in 2D is one in 3D whose gradient has nothing in its third row and column: strength,
// equation of state, viscosity and failure.
#include <random>

#include "check.hpp"
#include "example.hpp"
#include "one_point.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;
using mpm::testing::hard, mpm::testing::soft;

constexpr double stress_scale = 1e8;
constexpr BulkViscosity viscosity{1.5, 0.1};

template <class M>
ModelChoice flat_choice(const M& model, double yield) {
  ModelChoice choice{std::string(model.name), {}};
  for (const auto& p : M::params)
    choice.parameters[std::string(p.name)] =
        mpm::testing::example_value(p.name, p.unit, p.rule, yield);
  if (choice.parameters.contains("q_psi")) choice.parameters["q_psi"] = 0.3;
  return choice;
}

template <int D>
struct StrainedPoint : mpm::testing::OnePoint<D> {
  using mpm::testing::OnePoint<D>::OnePoint;
  void move(const Mat<double, 2>& gradient, double time_step, double time) {
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        this->block.gradient[i][j][0] = i < 2 && j < 2 ? gradient[i][j] : 0.0;
    const StressSettings settings{time_step, time, 0.5, this->material.viscosity, true};
    update_block<double, D>(this->material, this->columns, this->at, this->block, settings,
                            this->sums);
  }
};

/// Returns how many of its steps have made plastic strain; the tolerances are those of test_models,
/// some four roundings a step of stresses as large as the modulus.
int check_choice(mpm::testing::Report& report, const MaterialChoice& choice) {
  StrainedPoint<2> flat(choice);
  StrainedPoint<3> solid(choice);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-0.05, 0.05), decades(-3.7, 0.0);
  constexpr int steps = 40;
  constexpr double near = 4 * steps * (eps + 1e-13), time_step = 1e-4;
  constexpr int place[4] = {0, 1, 2, 5};  // of xx yy zz xy in 3D
  int flowing = 0;
  double plastic = 0.0;
  for (int step = 0; step < steps; ++step) {
    Mat<double, 2> gradient;
    const double size = std::pow(10.0, decades(random));
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) gradient[i][j] = size * any(random);
    // Little change of volume, or soils soon bear more pressure than these shears can overcome.
    const double mean = 0.4 * (gradient[0][0] + gradient[1][1]);
    for (int i = 0; i < 2; ++i) gradient[i][i] -= mean;
    flat.move(gradient, time_step, (step + 1) * time_step);
    solid.move(gradient, time_step, (step + 1) * time_step);
    for (const ColumnInfo& info : flat.columns.infos()) {
      if (info.name == "velocity") continue;
      const ColumnInfo& in_3d = solid.columns.info(info.name);
      const double scale = info.unit == "1" || info.unit == "K" ? 1e3 : stress_scale;
      for (int c = 0; c < info.components; ++c) {
        const int other = info.components == 1 ? 0 : place[c];
        const double a = flat.value(info, c), b = solid.value(in_3d, other);
        report.check(std::abs(a - b) <= near * (scale + std::abs(b)), __FILE__, __LINE__, info.name,
                     "2D, 3D, step", a, b, step);
      }
      for (int c = 3; c < 5 && in_3d.components == 6; ++c)
        CHECK_CLOSE(solid.value(in_3d, c), 0.0, near * scale);
      if (info.name != "plastic_strain") continue;
      flowing += flat.value(info, 0) > plastic + 1e-9;
      plastic = flat.value(info, 0);
    }
    const StressSums &a = flat.sums, &b = solid.sums;
    CHECK_CLOSE(a.internal, b.internal, near * stress_scale);
    CHECK_CLOSE(a.plastic, b.plastic, near * stress_scale);
    CHECK_CLOSE(a.viscous, b.viscous, near * (stress_scale + b.viscous));
    CHECK_CLOSE(a.force_power, b.force_power, near * (stress_scale + std::abs(b.force_power)));
    CHECK_CLOSE(a.fastest, b.fastest, near * b.fastest);
    const double speed = sound_speed<3>(solid.material, solid.columns, solid.at, 0, 0.5);
    CHECK_CLOSE(sound_speed<2>(flat.material, flat.columns, flat.at, 0, 0.5), speed, near * speed);
  }
  CHECK(flat.sums.viscous > 0.0, flat.sums.viscous);
  return flowing;
}

}  // namespace

void test_plane_strain(mpm::testing::Report& report) {
  const ModelChoice linear{"linear", {{"K", stress_scale}}};
  StrengthModels::for_each([&]<class Model>(const Model& model) {
    for (const double yield : {hard, soft}) {
      const ModelChoice strength = flat_choice(model, yield);
      using State = typename Model::template State<double, 2>;
      constexpr bool plastic = requires(State s) { s.plastic_strain; };
      if (Model::eos != EosUse::must) {
        const int flowing = check_choice(report, {1000.0, strength, {}, {}, viscosity});
        if (plastic) CHECK((flowing > 5) == (yield == soft), model.name, yield, flowing);
      }
      if (Model::eos != EosUse::never)
        check_choice(report, {1000.0, strength, linear, {}, viscosity});
    }
  });
  EosModels::for_each([&](const auto& model) {
    check_choice(report, {1000.0, {"fluid", {}}, flat_choice(model, hard), {}, viscosity});
  });
  FailureModels::for_each([&](const auto& model) {
    for (const char* action : {"no_shear", "no_tension", "erode"})
      check_choice(report, {1000.0,
                            flat_choice(J2{}, soft),
                            linear,
                            {{flat_choice(model, soft), action}},
                            viscosity});
  });
}
