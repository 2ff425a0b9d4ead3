// Sums in integers against closed forms and against any order.
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "check.hpp"
#include "mpm/math/exact_sum.hpp"

namespace {

using namespace mpm;

double sum_of(const std::vector<double>& values) {
  ExactSum sum;
  for (const double x : values) sum.add(x);
  return sum.value();
}

}  // namespace

void test_exact_sum(mpm::testing::Report& report) {
  using limits = std::numeric_limits<double>;
  CHECK_EQUAL(ExactSum().value(), 0.0);
  for (const double x : {1.0, -1.0, 0.1, -1e-300, 1e300, limits::max(), limits::denorm_min(),
                         -limits::min(), 3.0 * limits::denorm_min(), 0x1.fffffffffffffp31})
    CHECK_EQUAL(sum_of({x}), x);
  CHECK_EQUAL(sum_of({1e300, 1.0, -1e300}), 1.0);
  CHECK_EQUAL(sum_of({limits::max(), limits::max(), -limits::max()}), limits::max());
  CHECK_EQUAL(sum_of({limits::max(), limits::max()}), limits::infinity());
  CHECK_EQUAL(sum_of({limits::infinity(), 1.0}), limits::infinity());
  CHECK(std::isnan(sum_of({limits::infinity(), -limits::infinity()})));
  // To the nearest, of two the even one; whatever is below decides.
  CHECK_EQUAL(sum_of({1.0, 0x1p-53}), 1.0);
  CHECK_EQUAL(sum_of({1.0, 0x1p-53, 0x1p-1000}), 1.0 + 0x1p-52);
  CHECK_EQUAL(sum_of({1.0 + 0x1p-52, 0x1p-53}), 1.0 + 0x1p-51);
  CHECK_EQUAL(sum_of({-1.0, -0x1p-53, -0x1p-1000}), -1.0 - 0x1p-52);

  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-200, 200);
  for (int turn = 0; turn < 50; ++turn) {
    std::vector<double> values;
    values.reserve(400);
    for (int k = 0; k < 400; ++k) values.push_back(std::ldexp(any(random), exponent(random)));
    const double expected = sum_of(values);
    // What is added and taken away again leaves the rest, exactly.
    std::vector<double> both = values;
    both.reserve(3 * values.size());
    for (int k = 0; k < 400; ++k) {
      const double x = std::ldexp(any(random), exponent(random));
      both.push_back(x);
      both.push_back(-x);
    }
    std::ranges::shuffle(both, random);
    CHECK_EQUAL(sum_of(both), expected);
    ExactSum left, right;
    for (std::size_t k = 0; k < both.size(); ++k) (k % 3 == 0 ? left : right).add(both[k]);
    left.add(right);
    CHECK_EQUAL(left.value(), expected);

    // Of values of one size the long double is exact.
    std::vector<double> alike;
    FixedSum fixed, shuffled;
    long double reference = 0.0L;
    const SumUnit unit(-90);
    for (int k = 0; k < 300; ++k) {
      alike.push_back(std::ldexp(std::nearbyint(std::ldexp(any(random), 40)), -40));
      reference += alike.back();
      fixed.add(alike.back(), unit);
    }
    CHECK_EQUAL(sum_of(alike), static_cast<double>(reference));
    CHECK_EQUAL(fixed.value(unit), static_cast<double>(reference));
    for (double& x : alike) x = std::ldexp(x, exponent(random) / 10);
    FixedSum forth;
    for (const double x : alike) forth.add(x, unit);
    std::ranges::shuffle(alike, random);
    for (const double x : alike) shuffled.add(x, unit);
    CHECK_EQUAL(forth.value(unit), shuffled.value(unit));
    CHECK_CLOSE(forth.value(unit), sum_of(alike), 1e-15 * std::abs(sum_of(alike)) + 1e-24);
  }
}
