// Tiles: numbers of cells, neighbours and corners and back, sets of cells a bit each, and the order
// of tiles.
#include "check.hpp"
#include "mpm/layout/tile.hpp"

namespace {

using namespace mpm;

template <int D>
void check_numbers(mpm::testing::Report& report) {
  using T = Tile<D>;
  CHECK_EQUAL(T::cell_count, 64);  // a bit each in a word
  int next = 0;
  Index<D> low{}, high;
  high.fill(T::cells - 1);
  for_each_index<D>(low, high, [&](const Index<D>& i) {  // the first axis fastest
    CHECK_EQUAL(T::cell(i), next);
    CHECK(T::cell_index(next++) == i);
  });
  CHECK_EQUAL(next, T::cell_count);
  for (int k = 0; k < T::neighbours; ++k) {
    const Index<D> o = T::offset(k);
    CHECK_EQUAL(T::neighbour(o), k);
    if (k > 0) CHECK(tile_less<D>(T::offset(k - 1), o), k);
    Index<D> opposite = o;
    for (std::int32_t& x : opposite) x = -x;
    CHECK_EQUAL(T::neighbour(opposite), T::neighbours - 1 - k);
  }
  CHECK(T::offset(T::self) == Index<D>{});
  for (int k = 0; k < T::corners; ++k)
    for (int a = 0; a < D; ++a) CHECK_EQUAL(T::corner(k)[static_cast<std::size_t>(a)], k >> a & 1);
}

/// Sets of cells against what they say of each cell.
template <int D>
void check_sets(mpm::testing::Report& report) {
  using T = Tile<D>;
  constexpr std::uint64_t some = 0x9E3779B97F4A7C15;  // of no order
  for (std::size_t axis = 0; axis < D; ++axis) {
    for (int i = 0; i < T::cells; ++i)
      for (int c = 0; c < T::cell_count; ++c)
        CHECK_EQUAL((T::slice(axis, i) >> c & 1u) != 0, T::cell_index(c)[axis] == i);
    for (int by = -T::cells - 1; by <= T::cells + 1; ++by) {
      std::uint64_t expected = 0;
      for (int c = 0; c < T::cell_count; ++c) {
        Index<D> to = T::cell_index(c);
        to[axis] += by;
        if ((some >> c & 1u) && to[axis] >= 0 && to[axis] < T::cells)
          expected |= std::uint64_t{1} << T::cell(to);
      }
      CHECK_EQUAL(T::moved(some, axis, by), expected);
    }
  }
}

}  // namespace

void test_tile(mpm::testing::Report& report) {
  check_numbers<2>(report);
  check_numbers<3>(report);
  check_sets<2>(report);
  check_sets<3>(report);
  // The last axis counts most, and nothing is less than itself.
  CHECK((tile_less<2>({5, 0}, {-5, 1})) && (!tile_less<2>({-5, 1}, {5, 0})));
  CHECK((tile_less<3>({0, 1, 2}, {1, 1, 2})) && (!tile_less<3>({1, 1, 2}, {1, 1, 2})));
}
