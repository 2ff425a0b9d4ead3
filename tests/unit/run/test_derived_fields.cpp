// Fields that follow from what particles keep, against closed forms.
#include <random>

#include "check.hpp"
#include "mpm/run/derived_fields.hpp"

namespace {

using namespace mpm;

double value(std::string_view name, const ParticleState& state, int component = 0) {
  for (const DerivedField& field : derived_fields)
    if (field.name == name) return field.value(state, component);
  throw std::logic_error("there is no such field");
}

ParticleState stressed(double xx, double yy, double zz, double yz, double xz, double xy) {
  return {{xx, yy, zz, yz, xz, xy}, {1.0, 2.0, 3.0}, 8.0, 7.0, 3};
}

}  // namespace

void test_derived_fields(mpm::testing::Report& report) {
  constexpr double rounding = 1e-14;
  // Pressure alone: no equivalent stress.
  const ParticleState under_water = stressed(-5.0, -5.0, -5.0, 0.0, 0.0, 0.0);
  CHECK_CLOSE(value("pressure", under_water), 5.0, rounding);
  CHECK_CLOSE(value("von_mises", under_water), 0.0, rounding);
  // Of a bar in tension s it is s, of a sheet in shear t sqrt(3) t, whatever the axes.
  CHECK_CLOSE(value("pressure", stressed(0.0, 6.0, 0.0, 0.0, 0.0, 0.0)), -2.0, rounding);
  for (int axis = 0; axis < 3; ++axis) {
    ParticleState bar = stressed(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), sheet = bar;
    bar.stress[axis] = 3.0;
    sheet.stress[3 + axis] = -2.0;
    CHECK_CLOSE(value("von_mises", bar), 3.0, rounding);
    CHECK_CLOSE(value("von_mises", sheet), std::sqrt(3.0) * 2.0, rounding);
    CHECK_CLOSE(value("pressure", sheet), 0.0, rounding);
  }
  // A pressure on top changes the one by itself and the other not at all; the equivalent stress is
  // the deviator's sqrt(3/2 s : s), off the diagonal counted twice.
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    ParticleState state =
        stressed(any(random), any(random), any(random), any(random), any(random), any(random));
    const double p = value("pressure", state), q = value("von_mises", state);
    double product = 0.0;
    for (int i = 0; i < 6; ++i) {
      const double s = state.stress[i] + (i < 3 ? p : 0.0);
      product += (i < 3 ? 1.0 : 2.0) * s * s;
    }
    CHECK_CLOSE(q, std::sqrt(1.5 * product), rounding);
    for (int i = 0; i < 3; ++i) state.stress[i] -= 10.0;
    CHECK_CLOSE(value("pressure", state), p + 10.0, 10.0 * rounding);
    CHECK_CLOSE(value("von_mises", state), q, 100.0 * rounding);
  }
  // The edge of a cube of 8 m^3, of a square of 9 m^2.
  CHECK_CLOSE(value("size", under_water), 2.0, rounding);
  CHECK_CLOSE(value("size", {{}, {}, 9.0, 7.0, 2}), 3.0, rounding);
  CHECK_EQUAL(value("density", under_water), 7.0);
  for (int a = 0; a < 3; ++a) CHECK_EQUAL(value("displacement", under_water, a), a + 1.0);
  for (const DerivedField& field : derived_fields)
    CHECK_EQUAL(field.kept == Kept::once, field.name == std::string_view("size"));
}
