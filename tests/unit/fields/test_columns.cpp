// Columns by name: a name is taken once, and an unknown one is answered with those that there are.
#include "check.hpp"
#include "mpm/fields/columns.hpp"

void test_columns(mpm::testing::Report& report) {
  mpm::Columns columns;
  const int mass = columns.add("mass", "kg", 1), stress = columns.add("stress", "Pa", 6);
  const int failed = columns.add("failed", "1", 1);
  CHECK(mass == 0 && stress == 1 && failed == 7, mass, stress, failed);
  CHECK_THROWS(columns.add("stress", "Pa", 4), "two columns are named stress");
  CHECK_EQUAL(columns.component_count(), 8);
  CHECK_EQUAL(columns.info("stress").components, 6);
  CHECK_THROWS(columns.info("presure"),
               "no column is named presure; there are mass, stress, failed");
}
