// The region that is kept: closed, without limits where they are infinite, and a box lies in it if
// all its corners do.
#include <limits>
#include <random>

#include "check.hpp"
#include "mpm/grid/outflow_box.hpp"

namespace {

using namespace mpm;

template <int D>
void check_corners(mpm::testing::Report& report) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  OutflowBox<D> region;
  for (int a = 0; a < D; ++a) {
    region.lower[a] = -1.0;
    region.upper[a] = 1.0;
  }
  CHECK(region.holds(region.lower) && region.holds(region.upper));
  CHECK(region.holds(region.lower, region.upper));
  int inside = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Vec<double, D> low, high;
    for (int a = 0; a < D; ++a) {
      const double x = any(random), y = any(random);
      low[a] = std::min(x, y);
      high[a] = std::max(x, y);
    }
    bool all = true;
    for (int corner = 0; corner < 1 << D; ++corner) {
      Vec<double, D> x;
      for (int a = 0; a < D; ++a) x[a] = corner >> a & 1 ? high[a] : low[a];
      bool between = true;
      for (int a = 0; a < D; ++a) between = between && std::abs(x[a]) <= 1.0;
      CHECK_EQUAL(region.holds(x), between);
      all = all && between;
    }
    CHECK_EQUAL(region.holds(low, high), all);
    inside += all;
  }
  CHECK(inside > 50 && inside < 950, inside);
}

}  // namespace

void test_outflow_box(mpm::testing::Report& report) {
  check_corners<2>(report);
  check_corners<3>(report);
  OutflowBox<2> half;  // no limit but below
  const double infinite = std::numeric_limits<double>::infinity();
  half.lower = {-infinite, 0.0};
  half.upper = {infinite, infinite};
  CHECK(half.holds({1e300, 0.0}) && half.holds({-1e300, 1e300}) && !half.holds({0.0, -1e-300}));
  CHECK(!half.holds({std::numeric_limits<double>::quiet_NaN(), 1.0}));  // it is nowhere
}
