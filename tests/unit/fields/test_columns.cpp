// Columns by name: a name is taken once, and an unknown one is answered with those that there are.
// Columns of another memory space, as of a device, come from the host's and go back.
#include "check.hpp"
#include "mpm/fields/columns.hpp"

namespace {

/// Memory that the host reads as its own, and that counts what passes.
struct OtherSpace {
  using Block = mpm::Memory;
  static inline std::size_t came = 0, went = 0;  // bytes
  static Block allocate(std::size_t bytes) { return Block(bytes); }
  static void from_host(void* to, const void* from, std::size_t bytes) {
    came += bytes;
    std::memcpy(to, from, bytes);
  }
  static void to_host(void* to, const void* from, std::size_t bytes) {
    went += bytes;
    std::memcpy(to, from, bytes);
  }
};

void check_spaces(mpm::testing::Report& report) {
  mpm::Columns host;
  const int mass = host.add("mass", "kg", 1),
            v = host.add("velocity", "m/s", 2, mpm::Precision::rounded);
  host.allocate(100);
  for (std::size_t i = 0; i < 100; ++i) {
    host.component(mass)[i] = 2.0 * static_cast<double>(i);
    for (int a = 0; a < 2; ++a) host.rounded(v + a)[i] = static_cast<mpm::Storage>(a);
  }
  mpm::ColumnsIn<OtherSpace> there;
  there.copy_from_host(host);
  CHECK(there.rows() == 100 && there.info("velocity").components == 2);
  for (std::size_t i = 0; i < 100; ++i) {
    CHECK_EQUAL(there.component(mass)[i], 2.0 * static_cast<double>(i));
    there.component(mass)[i] += 1.0;
    there.rounded(v + 1)[i] = mpm::Storage{7};
  }
  there.copy_to_host(host);
  for (std::size_t i = 0; i < 100; ++i) {
    CHECK_EQUAL(host.component(mass)[i], 2.0 * static_cast<double>(i) + 1.0);
    CHECK(host.rounded(v)[i] == mpm::Storage{0} && host.rounded(v + 1)[i] == mpm::Storage{7}, i);
  }
  CHECK(OtherSpace::came == host.bytes() && OtherSpace::went == host.bytes());
}

}  // namespace

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
  check_spaces(report);
}
