// Functions of time: their values, and means against the midpoint rule on many small pieces.
#include <limits>

#include "check.hpp"
#include "mpm/math/time_function.hpp"

void test_time_function(mpm::testing::Report& report) {
  mpm::TimeFunction f(2.0);
  f.amplitude = 3.0;
  f.frequency = 0.7;
  f.phase = 0.4;
  f.times = {1.0, 1.5, 4.0};
  f.values = {5.0, -1.0, 2.0};
  CHECK(f.problem().empty());
  CHECK_CLOSE(f.at(0.0), 2.0 + 5.0 + 3.0 * std::sin(0.4), 1e-15);  // held before the first time
  const double angle = 2.0 * std::numbers::pi * 0.7;
  CHECK_CLOSE(f.at(9.0), 2.0 + 2.0 + 3.0 * std::sin(9.0 * angle + 0.4), 1e-13);
  CHECK_CLOSE(f.at(1.25), 2.0 + 2.0 + 3.0 * std::sin(1.25 * angle + 0.4), 1e-14);
  const double ends[] = {0.0, 0.3, 1.0, 1.2, 1.5, 3.9, 4.0, 6.0};
  for (const double from : ends)
    for (const double to : ends) {
      if (to <= from) continue;
      constexpr int pieces = 20000;
      double sum = 0.0;
      for (int k = 0; k < pieces; ++k) sum += f.at(from + (to - from) * (k + 0.5) / pieces);
      // The midpoint rule errs by (length of a piece)^2 / 24 times f'' (60 / s^2), and at a kink by
      // that length squared times the change of slope (12 / s) over the length.
      CHECK_CLOSE(f.mean(from, to), sum / pieces, 2e-6);
    }
  // Short steps: the mean is the value, without loss of digits.
  CHECK_CLOSE(f.mean(2.0, 2.0 + 1e-9), f.at(2.0 + 0.5e-9), 1e-14);
  CHECK_EQUAL(f.mean(2.0, 2.0), f.at(2.0));
  CHECK_EQUAL(mpm::TimeFunction(0.1).mean(0.3, 0.7), 0.1);
  CHECK(mpm::TimeFunction(0.0).vanishes());
  CHECK(!f.vanishes());
  f.times = {1.0, 1.0, 2.0};
  CHECK_EQUAL(f.problem(), std::string("must have increasing times"));
  f.times = {1.0};
  CHECK_EQUAL(f.problem(), std::string("must have as many values as times"));
  CHECK_EQUAL(mpm::TimeFunction(std::numeric_limits<double>::infinity()).problem(),
              std::string("must have finite numbers"));
}
