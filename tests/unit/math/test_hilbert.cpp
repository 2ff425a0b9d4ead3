// The Hilbert curve passes each place once, and goes from one to a neighbour.
#include <cstdlib>
#include <vector>

#include "check.hpp"
#include "mpm/math/hilbert.hpp"

namespace {

template <std::size_t D>
void check_curve(mpm::testing::Report& report, int bits) {
  const std::uint32_t side = std::uint32_t{1} << bits;
  std::size_t places = 1;
  for (std::size_t a = 0; a < D; ++a) places *= side;
  std::vector<std::array<std::uint32_t, D>> along(places);
  std::vector<int> passed(places, 0);
  for (std::size_t k = 0; k < places; ++k) {
    std::array<std::uint32_t, D> x;
    std::size_t rest = k;
    for (std::size_t a = 0; a < D; ++a, rest /= side)
      x[a] = static_cast<std::uint32_t>(rest % side);
    const auto number = static_cast<std::size_t>(mpm::hilbert_number<D>(x, bits));
    CHECK(number < places, number);
    if (number >= places) return;
    ++passed[number];
    along[number] = x;
  }
  for (std::size_t k = 0; k < places; ++k) {
    CHECK_EQUAL(passed[k], 1);
    if (k == 0) continue;
    int way = 0;
    for (std::size_t a = 0; a < D; ++a)
      way += std::abs(static_cast<int>(along[k][a]) - static_cast<int>(along[k - 1][a]));
    CHECK_EQUAL(way, 1);
  }
}

}  // namespace

void test_hilbert(mpm::testing::Report& report) {
  for (const int bits : {1, 2, 3, 4}) {
    check_curve<2>(report, bits);
    check_curve<3>(report, bits);
  }
}
