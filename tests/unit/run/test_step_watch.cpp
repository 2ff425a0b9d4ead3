// What judges steps by those before them: the last values and their median, time steps that
// collapse, energy that a step makes, loads that do much at once.
#include <deque>
#include <limits>
#include <random>

#include "check.hpp"
#include "mpm/run/step_watch.hpp"

namespace {

using namespace mpm;

/// The median of the last thousand is that of a sorted list of them.
void check_last_values(mpm::testing::Report& report) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  LastValues last;
  CHECK_EQUAL(last.median(), 0.0);
  std::deque<double> expected;
  for (int k = 0; k < 2500; ++k) {
    const double value = any(random) + 0.001 * k;
    last.add(value);
    expected.push_back(value);
    if (expected.size() > LastValues::window) expected.pop_front();
    if (k % 97 != 0 && k > 20) continue;
    std::vector<double> sorted(expected.begin(), expected.end());
    std::ranges::sort(sorted);
    CHECK_EQUAL(last.median(), sorted[sorted.size() / 2]);  // the upper one of two
  }
  CHECK(last.finite());
  last.add(std::numeric_limits<double>::quiet_NaN());
  CHECK(!last.finite());
}

/// A step is told if it lies below a tenth of the median, which is known after some steps, and if
/// steps fall slowly too.
void check_time_steps(mpm::testing::Report& report) {
  StepWatch young;
  for (std::size_t k = 1; k < StepWatch::first_steps; ++k) {
    const double found = young.median_fallen_below(2.0);
    CHECK_EQUAL(found, 0.0);
  }
  StepWatch old = young;
  // Too young to judge; one more step and it is not.
  const double too_early = young.median_fallen_below(0.1);
  CHECK_EQUAL(too_early, 0.0);
  const double last = old.median_fallen_below(2.0);
  CHECK_EQUAL(last, 0.0);
  for (const double step : {0.21, 0.19, 2.0, 0.05}) {
    const double found = old.median_fallen_below(step);
    CHECK_EQUAL(found, step < 0.2 ? 2.0 : 0.0);
  }
  const double none = old.median_fallen_below(std::numeric_limits<double>::infinity());
  CHECK_EQUAL(none, 0.0);  // all particles are gone
  CHECK(old.plausible());
  // By a thousandth each: told at the first below a tenth of the largest median so far, which is
  // that of the first ten.
  StepWatch slow;
  double step = 1.0, told = 0.0;
  for (int k = 0; k < 5000 && told == 0.0; ++k, step *= 0.999)
    if (slow.median_fallen_below(step) > 0.0) told = step;
  CHECK_CLOSE(told, 0.1, 0.1 * 0.01);
}

/// What numerics make in a step, once there have been steps, and more than a twentieth of the
/// largest energy.
void check_energy_made(mpm::testing::Report& report) {
  StepWatch watch;
  double made = 0.0;
  const auto step = [&](double more, double largest) {
    watch.median_fallen_below(1.0);
    made += more;
    return watch.energy_made(made, largest);
  };
  for (std::size_t k = 0; k < StepWatch::first_steps; ++k) {
    const double found = step(50.0, 100.0);
    CHECK_EQUAL(found, 0.0);
  }
  for (const double more : {4.9, 5.1, -50.0, 0.0, 6.0}) {
    const double found = step(more, 100.0);
    CHECK_CLOSE(found, more > 5.0 ? more : 0.0, 1e-12);
  }
  watch.start_from(1e6, 0.0);  // somebody has done much between two steps
  made = 1e6;
  const double found = step(1.0, 100.0);
  CHECK_EQUAL(found, 0.0);
}

/// Work per step n^power, as of a load that grows from rest, n steps so far: never told; ten times
/// the median of what it did at once is, forward or back.
void check_load_energy(mpm::testing::Report& report) {
  for (const double power : {0.0, 1.0, 2.0, 3.0}) {
    StepWatch watch;
    double work = 0.0, largest = 0.0, last = 0.0;
    for (int n = 1; n <= 3000; ++n) {
      last = std::pow(n, power);
      work += last;
      largest = std::max(largest, work);
      const double found = watch.load_energy(work, largest);
      CHECK_EQUAL(found, 0.0);
    }
    StepWatch other = watch;
    // The median is of the last thousand, the five hundredth before the end or the one beside it.
    const double ten_times = 10.0 * std::pow(2500.5, power);
    const double below = watch.load_energy(work + 0.98 * ten_times, 0.0);
    const double above = other.load_energy(work - 1.02 * ten_times, 0.0);
    CHECK_EQUAL(below, 0.0);
    CHECK_CLOSE(above, 1.02 * ten_times, 1e-9 * work);
  }
  // Much for the load, but little of the largest energy; and without loads nothing is counted.
  StepWatch watch;
  for (int n = 0; n < 50; ++n) watch.load_energy(1.0 * n, 1e6);
  const double little = watch.load_energy(1e4, 1e6), much = watch.load_energy(1e5, 1e6);
  CHECK_EQUAL(little, 0.0);
  CHECK_EQUAL(much, 9e4);
  StepWatch idle;
  for (int n = 0; n < 50; ++n) idle.load_energy(3.0, 100.0);
  const double first = idle.load_energy(90.0, 100.0);
  CHECK_EQUAL(first, 0.0);  // the second step of all that does work
  CHECK(idle.plausible());
  idle.start_from(std::numeric_limits<double>::infinity(), 0.0);
  CHECK(!idle.plausible());
}

}  // namespace

void test_step_watch(mpm::testing::Report& report) {
  check_last_values(report);
  check_time_steps(report);
  check_energy_made(report);
  check_load_energy(report);
}
