// SIMD lanes do what a double does, lane by lane; logarithm, exponential and power
// are as good as they say.
#include <cmath>
#include <limits>
#include <random>

#include "check.hpp"
#include "mpm/math/batch_math.hpp"
#include "mpm/math/scalar.hpp"
#include "mpm/math/store_chosen.hpp"

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
    CHECK_EQUAL(absolute(a)[k], std::abs(x[k]));
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

  // Lanes half the width apart are added first: in another order the small number is lost.
  Batch<W> cancelling(0.0);
  cancelling.v[0] = 1.0;
  cancelling.v[W / 2] = -1.0;
  if (W > 2) cancelling.v[1] = 1e-20;
  CHECK_EQUAL(sum(cancelling), W > 2 ? 1e-20 : 0.0);
}

template <int W>
void check_floor(mpm::testing::Report& report) {
  const double x[8] = {-1e-20, 2.9999999999999996, -3.0000000000000004, -0.5, -1.0, 524287.5, 1e-20,
                       0.0};
  for (int first = 0; first < 8; first += W)
    for (int k = 0; k < W; ++k)
      CHECK_EQUAL(floor(lanes_of<W>(x + first))[k], std::floor(x[first + k]));
}

/// As good as it says: exponents below 3 to some roundings of 2^-52 each.
void check_power_near_one(mpm::testing::Report& report) {
  for (const double a : {0.01, 0.31, 0.5, 1.0, 1.09, 2.0, 2.99})
    for (int k = -10; k <= 10; ++k) {
      const double x = 0.1 * k * PowerNearOne::reach;
      CHECK(std::abs(PowerNearOne(a)(x) / std::pow(1.0 + x, a) - 1.0) < 2e-15, a, x);
    }
  CHECK(PowerNearOne(2.99).exact() && !PowerNearOne(3.0).exact());
}

/// first_lanes(n) holds in lanes 0 .. n - 1 alone, any() and lane_bits() see a single lane.
template <int W>
void check_masks(mpm::testing::Report& report) {
  const Batch<W> one(1.0), zero(0.0);
  for (int n = 0; n <= W; ++n) {
    const auto mask = first_lanes<W>(n);
    CHECK_EQUAL(any(mask), n > 0);
    CHECK_EQUAL(lane_bits(mask), (std::uint64_t{1} << n) - 1);
    for (int k = 0; k < W; ++k) CHECK_EQUAL(select(mask, one, zero)[k], k < n ? 1.0 : 0.0);
  }
  for (int k = 0; k < W; ++k) {
    Batch<W> single(0.0);
    single.v[k] = 1.0;
    CHECK(any(single > zero), k);
    CHECK_EQUAL(lane_bits(single > zero), std::uint64_t{1} << k);
    CHECK(!any(single > one), k);
  }
}

/// All choices of lanes; what lies behind W numbers is not touched.
template <int W>
void check_chosen(mpm::testing::Report& report) {
  const double x[8] = {1.5, -2.25, 0.0, 1e300, -1e-300, 3.0, -0.1, 7.75};
  for (std::uint64_t lanes = 0; lanes < std::uint64_t{1} << W; ++lanes) {
    double to[W + 1];
    to[W] = 42.0;
    store_chosen(to, lanes_of<W>(x), lanes);
    int count = 0;
    for (int k = 0; k < W; ++k) {
      if (!(lanes >> k & 1u)) continue;
      CHECK_EQUAL(to[count], x[k]);
      ++count;
    }
    CHECK_EQUAL(to[W], 42.0);
  }
}

template <int W>
double lane_log(double x) {
  return log(Batch<W>(x))[W - 1];
}

}  // namespace

void test_batch(mpm::testing::Report& report) {
  check_power_near_one(report);
  check_operations<2>(report);
  check_masks<2>(report);
  check_floor<2>(report);
  check_chosen<2>(report);
  // On any processor: contact uses four lanes where the bits are to be the same on all.
  check_operations<4>(report);
  check_masks<4>(report);
  check_floor<4>(report);
  check_chosen<4>(report);
  if constexpr (native_lanes >= 8) {
    check_operations<8>(report);
    check_masks<8>(report);
    check_floor<8>(report);
    check_chosen<8>(report);
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
    CHECK_EQUAL(log_by_series(x), lane_log<W>(x));  // as a device has it
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

void test_exp_and_pow(mpm::testing::Report& report) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  const auto ulps = [](double got, long double exact) {
    const double rounded = static_cast<double>(exact);
    const double next = std::nextafter(std::abs(rounded), std::numeric_limits<double>::infinity());
    return static_cast<double>(std::abs(got - exact)) / (next - std::abs(rounded));
  };
  CHECK_EQUAL(exp(T(0.0))[W - 1], 1.0);
  CHECK(exp(T(-1e4))[0] < 1e-307 && exp(T(1e4))[0] > 8e307);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> wide(-707.0, 708.0), near(-1.0, 1.0), base(1e-6, 10.0);
  double worst = 0.0, worst_pow = 0.0;
  for (int n = 0; n < 200000; ++n) {
    const double x = n % 2 ? wide(random) : near(random);
    worst = std::max(worst, ulps(exp(T(x))[W - 1], std::exp(static_cast<long double>(x))));
    CHECK_EQUAL(exp_by_series(x), exp(T(x))[W - 1]);
    const double b = base(random), y = 4.0 * near(random);
    CHECK_EQUAL(pow_by_series(b, y), pow(T(b), T(y))[0]);
    const long double power = std::pow(static_cast<long double>(b), static_cast<long double>(y));
    const double allowed = 2.0 + 2.0 * std::abs(y * std::log(b));
    worst_pow = std::max(worst_pow, ulps(pow(T(b), T(y))[W - 1], power) / allowed);
  }
  CHECK(worst <= 2.0, worst);
  CHECK(worst_pow <= 1.0, worst_pow);
}
