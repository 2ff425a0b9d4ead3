// Blocks cut to the occupied cells: every node is held by all patches whose cells reach it, owned
// by the first of them, and holds their sum.
#include <map>
#include <random>

#include "check.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/grid/shared_nodes.hpp"

namespace {

using namespace mpm;

/// Mass at random at all nodes, summed; the field is the body's, or that of all if they are bonded.
template <int D>
void check_sums(mpm::testing::Report& report, TileGrid<D>& grid, Threads& threads,
                std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  using Key = std::pair<int, Index<D>>;
  std::map<Key, std::vector<double>> given;
  std::map<Key, int> owners;
  const auto for_each_node = [&](auto&& f) {
    for (std::size_t p = 0; p < grid.patches.size(); ++p) {
      const Patch<D>& patch = grid.patches[p];
      for (int n = 0; n < patch.shape.node_count; ++n) {
        Index<D> node = patch.shape.index(n);
        for (std::size_t a = 0; a < D; ++a) node[a] += grid.first_cell(patch.tile)[a];
        f(p, n, Key{grid.bonded ? 0 : patch.body, node});
      }
    }
  };
  for_each_node([&](std::size_t p, int n, const Key& key) {
    const double mass = any(random);
    grid.block(p).mass()[n] = mass;
    grid.block(p).velocity(0)[n] = 2.0 * mass;
    grid.block(p).force(0)[n] = mass;
    grid.block(p).dashpot_factor(D - 1)[n] = 3.0 * mass;
    given[key].push_back(mass);
    owners[key] += grid.patches[p].owned[n];
  });
  // Half by half, so that no other may change with one.
  sum_shared_nodes(grid, threads, 0, half_record);
  sum_shared_nodes(grid, threads, force_at, record);
  sum_shared_dashpots(grid, threads);
  constexpr double rounding = 1e-14;  // of up to 2 x 2^3 numbers below 1, added in another order
  for_each_node([&](std::size_t p, int n, const Key& key) {
    double sum = 0.0;
    for (const double m : given[key]) sum += m;
    CHECK_CLOSE(grid.block(p).mass()[n], sum, rounding);
    CHECK_EQUAL(grid.block(p).velocity(0)[n], 2.0 * grid.block(p).mass()[n]);
    CHECK_EQUAL(grid.block(p).force(0)[n], grid.block(p).mass()[n]);
    CHECK_CLOSE(grid.block(p).dashpot_factor(D - 1)[n], 3.0 * sum, 3.0 * rounding);
    CHECK_EQUAL(owners[key], 1);
  });
}

/// All nodes in reach of an occupied cell are there, and no smaller box holds them.
template <int D>
void check_shapes(mpm::testing::Report& report, const TileGrid<D>& grid) {
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const Patch<D>& patch = grid.patches[p];
    if (grid.bonded && patch.primary == p) continue;
    Index<D> first, last;
    first.fill(99);
    last.fill(-99);
    for (int c = 0; c < Tile<D>::cell_count; ++c)
      for (std::size_t a = 0; a < D && (patch.occupied >> c & 1u); ++a) {
        first[a] = std::min(first[a], Tile<D>::cell_index(c)[a] - grid.reach().before);
        last[a] = std::max(last[a], Tile<D>::cell_index(c)[a] + grid.reach().after);
      }
    if (patch.occupied == 0) {
      CHECK_EQUAL(patch.shape.node_count, 0);
    } else {
      CHECK(patch.shape.low == first && patch.shape.last() == last, p);
    }
  }
}

/// Two bodies in 3^D tiles, some cells occupied at random, and then others.
template <int D>
void check_blocks(mpm::testing::Report& report, BasisId basis, bool bonded) {
  std::mt19937_64 random(7);
  Threads threads(2);
  TileGrid<D> grid;
  grid.cell_size = 1.0;
  grid.basis = basis;
  grid.bonded = bonded;
  grid.has_dashpots = true;
  const auto occupy = [&](Patch<D>& patch) {
    const auto some = static_cast<unsigned>(random() % 5);  // sparse, so that blocks differ
    patch.occupied = some == 0 ? 0 : random();
    for (unsigned k = 1; k < some; ++k) patch.occupied &= random();
  };
  Index<D> low, high;
  low.fill(-1);
  high.fill(1);
  for (int body = 0; body < 2; ++body)
    for_each_index<D>(low, high, [&](const Index<D>& tile) {
      if (random() % 5 == 0) return;
      Patch<D>& patch = grid.patches.emplace_back();
      patch.body = body;
      patch.tile = tile;
      occupy(patch);
    });
  connect(grid);
  Patch<D> gone;
  for (int round = 0; round < 5; ++round) {
    cut_blocks(grid, threads);
    check_sums(report, grid, threads, random);
    check_shapes(report, grid);
    // Then particles move: one patch alone changes, one goes, one comes, and in the end many
    // change.
    if (round == 0) occupy(grid.patches[0]);
    if (round == 1) gone = grid.patches[3];
    if (round == 1) grid.patches.erase(grid.patches.begin() + 3);
    if (round == 2) {
      Patch<D>& patch = *grid.patches.emplace(grid.patches.begin() + 3);
      patch.body = gone.body;
      patch.tile = gone.tile;
      patch.occupied = gone.occupied;
    }
    if (round == 1 || round == 2) connect(grid);
    if (round == 3)
      for (Patch<D>& patch : grid.patches) occupy(patch);
  }
}

}  // namespace

void test_blocks(mpm::testing::Report& report) {
  for (const BasisId basis : {basis_id<Linear>, basis_id<Gimp>})
    for (const bool bonded : {false, true}) {
      check_blocks<2>(report, basis, bonded);
      check_blocks<3>(report, basis, bonded);
    }
}
