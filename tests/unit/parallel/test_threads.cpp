// Every index is worked on exactly once, for any number of threads and any length, also when the
// pool is resized.
#include <atomic>
#include <vector>

#include "check.hpp"
#include "mpm/parallel/threads.hpp"

void test_threads(mpm::testing::Report& report) {
  mpm::Threads threads;
  CHECK_EQUAL(threads.count(), 1);
  for (const int count : {1, 2, 3, 4, 5, 2}) {
    threads.resize(count);
    CHECK_EQUAL(threads.count(), count);
    for (const std::size_t n : {0u, 1u, 2u, 7u, 64u, 1000u, 4099u}) {
      const auto check_visits = [&] {
        std::vector<std::atomic<int>> visits(n + 1);
        threads.for_each(n, [&](std::size_t i) { ++visits[i]; });
        std::size_t wrong = visits[n] != 0;
        for (std::size_t i = 0; i < n; ++i) wrong += visits[i] != 1;
        CHECK(wrong == 0, wrong, n, count);
      };
      check_visits();
      // Parts of equal cost, all of it in the first or the last index, or none at all.
      for (const std::size_t dear : {std::size_t{0}, n - 1, n}) {
        threads.balance(n, [&](std::size_t i) { return i == dear ? 1.0 : 0.0; });
        check_visits();
      }
      threads.balance(n, [](std::size_t i) { return static_cast<double>(i); });
      check_visits();
    }
    // What one pass wrote the next one reads: a stage may rely on the stage before it.
    constexpr std::size_t n = 500;
    std::vector<std::size_t> value(n, 1);
    for (int pass = 0; pass < 50; ++pass) {
      std::vector<std::size_t> next(n);
      threads.for_each(n, [&](std::size_t i) { next[i] = value[i] + value[(i + 1) % n]; });
      threads.for_each(n, [&](std::size_t i) { value[i] = next[i] % 1000003; });
    }
    std::size_t differing = 0;
    for (const std::size_t v : value) differing += v != value[0];
    CHECK(differing == 0, differing, count);
  }
}
