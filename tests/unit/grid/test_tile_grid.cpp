// From positions to cells, tiles and nodes and back, and the region that is kept.
#include "check.hpp"
#include "mpm/grid/tile_grid.hpp"

namespace {

using namespace mpm;

template <int D>
void check_places(mpm::testing::Report& report, BasisId basis) {
  TileGrid<D> grid;
  grid.cell_size = 0.5;
  grid.basis = basis;
  for (int a = 0; a < D; ++a) grid.origin[a] = 10.0 + a;
  grid.anchor.fill(3);
  const double own = grid.reach().own_node;  // of a cell's own node, in the cell
  for (int k = -20; k <= 20; ++k) {
    Index<D> node;
    node.fill(k);
    const Vec<double, D> at = grid.position_of(node);
    for (int a = 0; a < D; ++a) {
      CHECK_CLOSE(at[a], 10.0 + a + 0.5 * k, 1e-14);
      CHECK_CLOSE(grid.among_nodes(at[a], a), k, 1e-12);
      CHECK_CLOSE(grid.in_cells(at[a], a), k + own, 1e-12);
    }
    // A cell holds its own node, where that is not on its face, and what lies beside it.
    Vec<double, D> beside = at;
    for (int a = 0; a < D; ++a) beside[a] += 0.1;
    CHECK(grid.cell_of(beside) == node, k);
    const Index<D> tile = grid.tile_of(node), first = grid.first_cell(tile);
    for (std::size_t a = 0; a < D; ++a)
      CHECK(first[a] <= k && k < first[a] + Tile<D>::cells && (first[a] - 3) % Tile<D>::cells == 0,
            k, first[a]);
  }
  CHECK(local_coordinate(4.0, 4.0) > 0.0 && local_coordinate(5.0, 4.0) < 1.0);
}

}  // namespace

void test_tile_grid(mpm::testing::Report& report) {
  Bases::for_each([&](BasisId id, const auto&) {
    check_places<2>(report, id);
    check_places<3>(report, id);
  });
  OutflowBox<2> box;
  box.lower = {0.0, -1.0};
  box.upper = {2.0, 1.0};
  CHECK(box.holds({0.0, 1.0}) && !box.holds({-1e-9, 0.0}) && !box.holds({1.0, 1.5}));
  CHECK(box.holds({0.5, 0.0}, {2.0, 1.0}) && !box.holds({0.5, 0.0}, {2.5, 1.0}));
}
