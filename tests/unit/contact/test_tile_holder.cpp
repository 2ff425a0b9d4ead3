// Which of a tile's nodes are in a holder's block and have mass, where their records are, and from
// which cells they are in reach.
#include <random>

#include "check.hpp"
#include "mpm/contact/tile_holder.hpp"
#include "mpm/contact/tile_particles.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"

namespace {

using namespace mpm;

/// All neighbours of a patch, node by node, with masses at random.
template <int D>
void check_nodes(mpm::testing::Report& report, BasisId basis) {
  std::mt19937_64 random(3);
  std::bernoulli_distribution has_mass(0.4);
  TileGrid<D> grid;
  grid.cell_size = 1.0;
  grid.basis = basis;
  grid.patches.resize(2);
  for (Patch<D>& patch : grid.patches) patch.in_contact = true;
  grid.patches[0].occupied = random();                                     // all over the tile
  grid.patches[1].occupied = Tile<D>::slice(0, 1) & Tile<D>::slice(1, 2);  // a row or one cell
  grid.patches[1].body = 1;
  Threads threads(1);
  connect(grid);
  cut_blocks(grid, threads);
  for (std::size_t p = 0; p < 2; ++p)
    for (int n = 0; n < grid.patches[p].shape.node_count; ++n)
      grid.block(p).mass()[n] = has_mass(random) ? 0.5 : 0.0;
  NodesWithMass<D> masses;
  masses.find(grid, threads);
  for (int patch = 0; patch < 2; ++patch)
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const TileHolder holder(patch, static_cast<std::size_t>(patch), k);
      bool reached = true;
      for (const int o : Tile<D>::offset(k))
        reached = reached && (o >= 0 || grid.reach().before > 0);
      if (!reached) continue;
      const std::uint64_t found = masses.in_tile(grid, holder);
      HeldNodes<D> held{found};
      held.locate(grid, holder);
      for (int cell = 0; cell < Tile<D>::cell_count; ++cell) {
        const Index<D> node = Tile<D>::cell_index(cell);
        const bool expected = shape_of(grid, holder).holds(seen_from<D>(holder, node)) &&
                              grid.block(static_cast<std::size_t>(patch))
                                      .mass()[node_in_holder<D>(grid, holder, node)] > 0.0;
        CHECK((found >> cell & 1u) == (expected ? 1u : 0u), patch, k, cell);
        if (!expected) continue;
        const NodeBlock<D> block = grid.block(static_cast<std::size_t>(patch));
        const double* const numbers = block.records[node_in_holder<D>(grid, holder, node)];
        CHECK(grid.nodes.record_at(held.place(node)) == numbers, patch, k, cell);
      }
    }
}

/// All neighbours of a tile, cell by cell, for nodes at random.
template <int D>
void check_reach(mpm::testing::Report& report, const Reach& reach) {
  std::mt19937_64 random(5);
  for (int turn = 0; turn < 20; ++turn) {
    // Many nodes, few, one.
    std::uint64_t nodes = random();
    if (turn % 3 > 0) nodes &= random() & random() & random();
    if (turn % 3 > 1) nodes = std::uint64_t{1} << random() % 64;
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const Index<D> offset = Tile<D>::offset(k);
      const std::uint64_t found = cells_in_reach<D>(nodes, offset, reach);
      for (int c = 0; c < Tile<D>::cell_count; ++c) {
        bool expected = false;
        for (int n = 0; n < Tile<D>::cell_count; ++n) {
          bool reached = nodes >> n & 1u;
          for (std::size_t a = 0; a < D; ++a) {
            const int cell = Tile<D>::cell_index(c)[a] + Tile<D>::cells * offset[a];
            const int from_node = cell - Tile<D>::cell_index(n)[a];
            reached = reached && from_node >= -reach.after && from_node <= reach.before;
          }
          expected = expected || reached;
        }
        CHECK((found >> c & 1u) == (expected ? 1u : 0u), turn, k, c);
      }
    }
  }
}

}  // namespace

void test_tile_holder(mpm::testing::Report& report) {
  check_nodes<2>(report, basis_id<Linear>);
  check_nodes<2>(report, basis_id<Gimp>);
  check_nodes<3>(report, basis_id<Linear>);
  check_nodes<3>(report, basis_id<Gimp>);
  for (const Reach& reach : {Reach{0, 1, 0.0}, Reach{1, 1, 0.5}, Reach{1, 2, 0.0}}) {
    check_reach<2>(report, reach);
    check_reach<3>(report, reach);
  }
}
