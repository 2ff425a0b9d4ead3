// SIMD lanes do what a double does, lane by lane; the logarithm is good to 1 ulp.
#include <cmath>
#include <limits>
#include <random>

#include "check.hpp"
#include "mpm/math/batch_math.hpp"
#include "mpm/math/scalar.hpp"

namespace {

using namespace mpm;

template <int W>
Batch<W> lanes_of(const double* values) {
  return Batch<W>::load(values);
}

/// Every operation of Batch against the same on double, exactly: both are correctly rounded.
template <int W>
void check_operations(mpm::testing::Report& report) {
  const double x[8] = {1.5, -2.25, 0.0, 1e300, -1e-300, 3.0, -0.1, 7.75};
  const double y[8] = {-0.5, 3.125, 4.0, 1e-10, 2e-300, 3.0, 0.3, -1e20};
  const Batch<W> a = lanes_of<W>(x), b = lanes_of<W>(y);
  for (int k = 0; k < W; ++k) {
    CHECK_EQUAL((a + b)[k], x[k] + y[k]);
    CHECK_EQUAL((a - b)[k], x[k] - y[k]);
    CHECK_EQUAL((a * b)[k], x[k] * y[k]);
    CHECK_EQUAL((a / b)[k], x[k] / y[k]);
    CHECK_EQUAL((-a)[k], -x[k]);
    CHECK_EQUAL(min(a, b)[k], std::min(x[k], y[k]));
    CHECK_EQUAL(max(a, b)[k], std::max(x[k], y[k]));
    CHECK_EQUAL(sqrt(b * b)[k], std::sqrt(y[k] * y[k]));
    CHECK_EQUAL(select(a < b, a, b)[k], x[k] < y[k] ? x[k] : y[k]);
    CHECK_EQUAL(select((!(a >= b)) | (a > b), a, b)[k], x[k] != y[k] ? x[k] : y[k]);
    CHECK_EQUAL(select((a <= b) & (a >= b), a, b)[k], x[k] == y[k] ? x[k] : y[k]);
  }
  double total = x[0], most = x[0];
  for (int k = 1; k < W; ++k) {
    total += x[k];
    most = std::max(most, x[k]);
  }
  CHECK_EQUAL(sum(a), total);
  CHECK_EQUAL(largest(a), most);
}

/// first_lanes(n) holds in lanes 0 .. n - 1 alone, and any() sees a single lane.
template <int W>
void check_masks(mpm::testing::Report& report) {
  const Batch<W> one(1.0), zero(0.0);
  for (int n = 0; n <= W; ++n) {
    const auto mask = first_lanes<W>(n);
    CHECK_EQUAL(any(mask), n > 0);
    for (int k = 0; k < W; ++k) CHECK_EQUAL(select(mask, one, zero)[k], k < n ? 1.0 : 0.0);
  }
  for (int k = 0; k < W; ++k) {
    Batch<W> single(0.0);
    single.v[k] = 1.0;
    CHECK(any(single > zero), k);
    CHECK(!any(single > one), k);
  }
}

template <int W>
double lane_log(double x) {
  return log(Batch<W>(x))[W - 1];
}

}  // namespace

void test_batch(mpm::testing::Report& report) {
  check_operations<2>(report);
  check_masks<2>(report);
  if constexpr (native_lanes >= 4) {
    check_operations<4>(report);
    check_masks<4>(report);
  }
  if constexpr (native_lanes >= 8) {
    check_operations<8>(report);
    check_masks<8>(report);
  }
}

void test_log(mpm::testing::Report& report) {
  constexpr int W = native_lanes;
  CHECK_EQUAL(lane_log<W>(1.0), 0.0);
  std::mt19937_64 random(1);
  // Near one, where cancellation would show, and over all normal doubles.
  std::uniform_real_distribution<double> near(0.5, 2.0), exponent(-1021.0, 1023.0);
  double worst = 0.0, worst_at = 0.0;
  for (int n = 0; n < 200000; ++n) {
    double x = near(random);
    if (n % 4 == 1) x = 1.0 + (x - 1.0) * 1e-6;
    if (n % 2 == 0) x = std::ldexp(x, static_cast<int>(exponent(random)));
    const long double exact = std::log(static_cast<long double>(x));
    const double rounded = static_cast<double>(exact);
    const double next = std::nextafter(std::abs(rounded), std::numeric_limits<double>::infinity());
    const double error = static_cast<double>(std::abs(lane_log<W>(x) - exact));
    const double ulps = error / (next - std::abs(rounded));
    if (ulps > worst) {
      worst = ulps;
      worst_at = x;
    }
  }
  CHECK(worst <= 1.0, worst, worst_at);
}
