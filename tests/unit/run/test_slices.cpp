// Rows that ranks have in any order come to those that write them.
#include <numeric>
#include <random>

#include "check.hpp"
#include "mpm/run/gather.hpp"
#include "on_ranks.hpp"

namespace {

using namespace mpm;
using testing::on_ranks;

void check_ranges(mpm::testing::Report& report, std::size_t rows, const std::vector<int>& ranks) {
  const Slices slices(rows, ranks);
  std::size_t next = 0;
  for (std::size_t s = 0; s < slices.size(); ++s) {
    const Share share = slices.of(ranks[s]);
    CHECK_EQUAL(share.first, next);
    next = share.last;
    CHECK(share.count() <= rows / ranks.size() + 1, rows, s, share.count());
    for (std::size_t row = share.first; row < share.last; ++row)
      CHECK_EQUAL(slices.slice_with(row), s);
  }
  CHECK_EQUAL(next, rows);
  CHECK_EQUAL(slices.of(ranks.back() + 1).count(), std::size_t{0});
}

/// Each row is that of a rank by chance; its numbers are 10 row + place.
void check_gather(mpm::testing::Report& report, std::size_t rows, const std::vector<int>& writers) {
  constexpr std::size_t width = 3;
  constexpr int size = 5;
  std::vector<std::vector<int>> got(size);
  on_ranks(size, [&](Comm& comm) {
    const Slices slices(rows, writers);
    std::vector<int>& own = got[static_cast<std::size_t>(comm.rank())];
    own.resize(slices.of(comm.rank()).count() * width);
    constexpr std::array places{2, 0, 1};
    gather(comm, slices, width, places, std::span(own), [&](auto&& f) {
      for (std::size_t c = 0; c < width; ++c) {
        std::minstd_rand random(7);
        for (std::size_t row = 0; row < rows; ++row)
          if (random() % size == static_cast<unsigned>(comm.rank()))
            f(row, c, 10 * static_cast<int>(row) + places[c]);
      }
    });
  });
  std::vector<int> all;
  for (const std::vector<int>& part : got) all.insert(all.end(), part.begin(), part.end());
  CHECK_EQUAL(all.size(), rows * width);
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    wrong += all[k] != static_cast<int>(10 * (k / width) + k % width);
  CHECK_EQUAL(wrong, std::size_t{0});
}

}  // namespace

void test_slices(mpm::testing::Report& report) {
  for (const std::size_t rows : {0, 1, 2, 5, 7, 100, 101})
    for (const std::vector<int>& ranks : {std::vector{0}, {0, 1}, {0, 2, 3}, {0, 1, 2, 3, 4}}) {
      check_ranges(report, rows, ranks);
      check_gather(report, rows, ranks);
    }
  CHECK(testing::throws([] { Slices(3, std::vector<int>{}); }, "rise"));
  CHECK(testing::throws([] { Slices(3, {0, 0}); }, "rise"));
}
