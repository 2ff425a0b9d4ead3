// Memory of arrays, small and large: aligned, all of it writable, and nothing left of the old.
// And rows in sequence, which are found two numbers at a time.
#include <vector>

#include "check.hpp"
#include "mpm/fields/aligned.hpp"
#include "mpm/fields/lanes.hpp"

namespace {

using namespace mpm;

template <int W>
void check_rows(mpm::testing::Report& report) {
  std::vector<std::uint32_t> rows(W);
  for (int k = 0; k < W; ++k) rows[static_cast<std::size_t>(k)] = 7u + static_cast<unsigned>(k);
  CHECK(LaneRows<W>(rows.data(), W).contiguous, W);
  for (std::size_t k = 0; k < W; ++k) {
    auto other = rows;
    ++other[k];
    CHECK(!LaneRows<W>(other.data(), W).contiguous, W, k);
    // Of fewer rows only those count.
    if (k == 0) continue;
    const LaneRows<W> fewer(other.data(), k);
    CHECK(fewer.contiguous && fewer.count == static_cast<int>(k), W, k);
  }
}

}  // namespace

void test_memory(mpm::testing::Report& report) {
  AlignedArray<double> array;
  // Small, just short of what comes in huge pages from the system, that, more, and small again.
  for (const std::size_t n : {1u, 100u, 524287u, 524288u, 700001u, 3u}) {
    array.release_and_allocate(n);
    CHECK_EQUAL(array.size(), n);
    CHECK_EQUAL(array.bytes(), n * sizeof(double));
    CHECK_EQUAL(reinterpret_cast<std::uintptr_t>(array.data()) % cache_line, std::uintptr_t{0});
    for (std::size_t i = 0; i < n; ++i) array.data()[i] = static_cast<double>(i);
    CHECK_EQUAL(array.data()[n - 1], static_cast<double>(n - 1));
  }
  array.release_and_allocate(0);
  CHECK_EQUAL(array.size(), std::size_t{0});
  check_rows<2>(report);
  check_rows<4>(report);
  check_rows<8>(report);
}
