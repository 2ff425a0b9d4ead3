// The harness itself: a failed check is counted and names the place, the expression and the values.
#include <limits>
#include <stdexcept>

#include "check.hpp"

namespace {

mpm::testing::Report failing() {
  mpm::testing::Report report;
  const int two = 2;
  CHECK(two == 3, two);
  CHECK_EQUAL(two, 4);
  CHECK_CLOSE(1.0, std::numeric_limits<double>::quiet_NaN(), 1.0);
  CHECK_THROWS(throw std::runtime_error("cell size"), "density");
  return report;
}

bool holds(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

void test_check(mpm::testing::Report& report) {
  const auto inner = failing();
  CHECK_EQUAL(inner.check_count(), 4u);
  CHECK_EQUAL(inner.failures().size(), 4u);
  if (inner.failures().size() != 4) return;
  CHECK(holds(inner.failures()[0], "test_check.cpp:12: two == 3; (two) = 2"), inner.failures()[0]);
  CHECK(holds(inner.failures()[1], "two == 4; (two, 4) = 2 4"), inner.failures()[1]);
  CHECK(holds(inner.failures()[2], "nan"), inner.failures()[2]);
  CHECK(holds(inner.failures()[3], "throws \"density\""), inner.failures()[3]);
  CHECK_THROWS(throw std::runtime_error("cell size"), "cell");
  CHECK_CLOSE(0.1 + 0.2, 0.3, 1e-15);
}
