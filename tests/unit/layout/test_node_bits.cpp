// One bit for each node of a block, against a list of bools.
#include <random>
#include <vector>

#include "check.hpp"
#include "mpm/layout/node_bits.hpp"

namespace {

using namespace mpm;

template <int D>
void check_bits(mpm::testing::Report& report) {
  constexpr int most = BlockShape<D>::nodes_max;
  constexpr int longest = Tile<D>::cells + Bases::before_max + Bases::after_max;  // a row of nodes
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    NodeBits<D> bits;
    bits.fill(most);  // what was set before must go
    const int count = trial == 0 ? most : static_cast<int>(random() % most) + 1;
    bits.fill(count);
    std::vector<bool> expected(static_cast<std::size_t>(most), false);
    std::fill_n(expected.begin(), count, true);
    for (int k = 0; k < 20; ++k) {
      const int length = static_cast<int>(random() % longest) + 1;
      const int first = static_cast<int>(random() % static_cast<unsigned>(most - length + 1));
      bits.clear_row(first, length);
      std::fill_n(expected.begin() + first, length, false);
    }
    for (int n = 0; n < most; ++n) {
      CHECK_EQUAL(bits[n], bool{expected[static_cast<std::size_t>(n)]});
      const int length = std::min(longest, most - n);
      std::uint64_t row = 0;
      for (int i = 0; i < length; ++i)
        row |= std::uint64_t{expected[static_cast<std::size_t>(n + i)]} << i;
      CHECK_EQUAL(bits.row(n, length), row);
    }
  }
}

}  // namespace

void test_node_bits(mpm::testing::Report& report) {
  check_bits<2>(report);
  check_bits<3>(report);
}
