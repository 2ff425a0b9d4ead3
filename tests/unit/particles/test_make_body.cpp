// A body from numbers: masses, means and kinds, and a sentence for what is none.
#include <limits>
#include <vector>

#include "check.hpp"
#include "mpm/particles/make_body.hpp"

void test_make_body(mpm::testing::Report& report) {
  using namespace mpm;
  TileGrid<2> grid;
  grid.cell_size = 1.0;
  const Material steel = make_material({8.0, {"elastic", {{"E", 2.0}, {"nu", 0.0}}}, {}, {}, {}});
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0, 5.0}, v{7.0, -1.0}, each{1.0, 2.0, 3.0};
  const Body<2> body = make_body<2>("bar", steel, x, v, each, grid);
  CHECK(body.count() == 3 && body.active() == 3 && body.deforms());
  CHECK_EQUAL(body.total_mass, 48.0);
  CHECK_EQUAL(body.mean_mass, 16.0);
  CHECK_CLOSE(body.mean_edge, std::sqrt(2.0), 1e-15);
  CHECK_CLOSE(body.stiffness, 2.0, 1e-14);  // rho c^2 = E for nu = 0
  CHECK_CLOSE(body.shear_impedance, std::sqrt(8.0 * 1.0), 1e-14);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(body.id[i] == i && body.x(0)[i] == x[2 * i] && body.x(1)[i] == x[2 * i + 1], i);
    CHECK(body.mass()[i] == 8.0 * each[i] && body.volume()[i] == each[i], i);
    CHECK(body.v(0)[i] == Rounded{7.0} && body.v(1)[i] == Rounded{-1.0}, i);
  }
  const Body<2> stone =
      make_body<2>("stone", make_material({8.0, {"rigid", {}}, {}, {}, {}}), x, v, each, grid);
  CHECK(stone.is_free_rigid() && !stone.deforms() && std::isinf(stone.stiffness));

  const auto refused = [&](std::vector<double> places, std::vector<double> speeds,
                           std::vector<double> volumes, const char* part) {
    CHECK(mpm::testing::throws([&] { make_body<2>("bar", steel, places, speeds, volumes, grid); },
                               part),
          part);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused({}, v, each, "bar: positions must be (n, D) with n > 0");
  refused({0.0, 1.0, 2.0}, v, {1.0}, "positions must be (n, D)");
  refused(x, {1.0, 2.0, 3.0}, each, "velocities must be");
  refused(x, v, {1.0, 2.0}, "volumes must be (n,) or (1,)");
  refused(x, v, {1.0, 0.0, 2.0}, "volumes must be > 0");
  refused({0.0, nan}, v, {1.0}, "positions must be finite");
}
