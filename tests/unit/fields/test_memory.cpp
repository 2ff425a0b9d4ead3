// Memory of arrays, small and large: aligned, all of it writable, and nothing left of the old.
// And rows in sequence, which are found two numbers at a time; columns of doubles and of floats.
#include <limits>
#include <vector>

#include "check.hpp"
#include "mpm/fields/lanes.hpp"
#include "mpm/fields/memory_space.hpp"

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

/// Rows that follow each other and rows that do not are read as they are, and only they are
/// written.
template <int W, class Number>
void check_column(mpm::testing::Report& report) {
  std::vector<Number> column(40);
  const auto start = [&] {
    for (std::size_t i = 0; i < column.size(); ++i)
      column[i] = static_cast<Number>(static_cast<double>(i) + 0.1);
  };
  std::vector<std::uint32_t> rows(W);
  for (const std::uint32_t step : {1u, 3u})
    for (std::size_t count = 1; count <= W; ++count) {
      start();
      for (std::size_t k = 0; k < W; ++k) rows[k] = 2u + step * static_cast<std::uint32_t>(k);
      const LaneRows<W> lanes(rows.data(), count);
      const Batch<W> read = load(column.data(), lanes);
      for (int k = 0; k < lanes.count; ++k) CHECK_EQUAL(read[k], double{column[lanes[k]]});
      store(column.data(), lanes, read + Batch<W>(0.7));
      double sum = 0.0;
      for (const Number x : column) sum += x;
      // The nearest number of that kind, of numbers below 40.
      const double eps = 40.0 * std::numeric_limits<Number>::epsilon();
      for (int k = 0; k < lanes.count; ++k)
        CHECK_CLOSE(double{column[lanes[k]]}, read[k] + 0.7, eps);
      start();
      for (const Number x : column) sum -= x;
      CHECK_CLOSE(sum, 0.7 * static_cast<double>(count), 100.0 * eps);
    }
}

template <class Number>
void check_columns(mpm::testing::Report& report) {
  check_column<2, Number>(report);
  check_column<4, Number>(report);
  check_column<8, Number>(report);
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
  check_columns<double>(report);
  check_columns<float>(report);
}
