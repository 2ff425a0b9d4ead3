// The box of nodes of a block: around the occupied cells, as far as the basis reaches; numbers of
// nodes and back; the box of two boxes.
#include <random>

#include "check.hpp"
#include "mpm/layout/block_shape.hpp"

namespace {

using namespace mpm;

/// Cells at random, sometimes a few and sometimes most.
std::uint64_t some_cells(std::mt19937_64& random) {
  std::uint64_t cells = random();
  for (std::uint64_t k = random() % 7; k > 0; --k) cells &= random();
  return cells;
}

template <int D>
void check_shape(mpm::testing::Report& report, const BlockShape<D>& shape, std::uint64_t occupied,
                 const Reach& reach) {
  CHECK(shape.node_count <= BlockShape<D>::nodes_max, shape.node_count);
  // Every node that a cell reaches is in the box, and on each face there is one.
  std::array<bool, std::size_t{2} * D> on_face{};
  for (int c = 0; c < Tile<D>::cell_count; ++c) {
    if (!(occupied >> c & 1u)) continue;
    Index<D> first = Tile<D>::cell_index(c), last = first;
    for (std::int32_t& i : first) i -= reach.before;
    for (std::int32_t& i : last) i += reach.after;
    CHECK(shape.holds(first) && shape.holds(last), c);
    for (std::size_t a = 0; a < D; ++a) {
      on_face[2 * a] = on_face[2 * a] || first[a] == shape.low[a];
      on_face[2 * a + 1] = on_face[2 * a + 1] || last[a] == shape.last()[a];
    }
  }
  for (const bool touched : on_face) CHECK(touched);
  for (int n = 0; n < shape.node_count; ++n) {
    const Index<D> i = shape.index(n);
    CHECK_EQUAL(shape.node(i), n);
    CHECK(shape.holds(i), n);
    for (int k = 0; k < Tile<D>::corners; ++k) {
      Index<D> corner = i;
      for (std::size_t a = 0; a < D; ++a) corner[a] += Tile<D>::corner(k)[a];
      if (shape.holds(corner))
        CHECK_EQUAL(n + shape.corner_offset[static_cast<std::size_t>(k)], shape.node(corner));
    }
  }
  Index<D> beyond = shape.last();
  ++beyond[D - 1];
  CHECK(!shape.holds(beyond));
}

template <int D>
void check_shapes(mpm::testing::Report& report) {
  std::mt19937_64 random(2);
  for (const BasisId basis : {basis_id<Linear>, basis_id<Gimp>, basis_id<QuadraticBSpline>})
    for (int trial = 0; trial < 50; ++trial) {
      const Reach reach = reach_of(basis);
      const std::uint64_t one = some_cells(random), other = some_cells(random);
      const auto shape = BlockShape<D>::around(one, reach);
      if (one != 0) check_shape(report, shape, one, reach);
      // The box of both sets of cells is that of their boxes.
      const auto joined = shape.joined_with(BlockShape<D>::around(other, reach));
      CHECK(joined == BlockShape<D>::around(one | other, reach), trial);
    }
  const BlockShape<D> none = BlockShape<D>::around(0, reach_of(basis_id<Linear>));
  CHECK_EQUAL(none.node_count, 0);
  CHECK(!none.holds({}));
  CHECK_EQUAL((BlockShape<D>::around(~std::uint64_t{0}, reach_of(basis_id<Gimp>)).node_count),
              power(Tile<D>::cells + 2, D));
}

}  // namespace

void test_block_shape(mpm::testing::Report& report) {
  check_shapes<2>(report);
  check_shapes<3>(report);
}
