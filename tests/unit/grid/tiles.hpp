#pragma once
// Patches without particles for tests of the grid: two bodies in 3^D tiles, some cells occupied at
// random, and then others.
#include <random>

#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"

namespace mpm::testing {

template <int D>
struct Tiles {
  std::mt19937_64 random{7};
  Threads threads{2};
  TileGrid<D> grid;

  Tiles(BasisId basis, bool bonded) {
    grid.cell_size = 1.0;
    grid.basis = basis;
    grid.bonded = bonded;
    grid.has_dashpots = true;
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
    connect();
  }
  void connect() { mpm::connect(grid); }
  void cut() { cut_blocks(grid, threads); }

  /// Particles move: one patch alone changes, one goes, one comes, and in the end many change.
  static constexpr int rounds = 5;
  void change(int round) {
    if (round == 0) occupy(grid.patches[0]);
    if (round == 1) gone_ = grid.patches[3];
    if (round == 1) grid.patches.erase(grid.patches.begin() + 3);
    if (round == 2) {
      Patch<D>& patch = *grid.patches.emplace(grid.patches.begin() + 3);
      patch.body = gone_.body;
      patch.tile = gone_.tile;
      patch.occupied = gone_.occupied;
    }
    if (round == 1 || round == 2) connect();
    if (round == 3)
      for (Patch<D>& patch : grid.patches) occupy(patch);
  }
  /// f(patch, node, its coordinates) for all nodes of all patches, in the order of the patches.
  template <class F>
  void for_each_node(F&& f) const {
    for (std::size_t p = 0; p < grid.patches.size(); ++p)
      for (int n = 0; n < grid.patches[p].shape.node_count; ++n) {
        Index<D> node = grid.patches[p].shape.index(n);
        for (std::size_t a = 0; a < D; ++a) node[a] += grid.first_cell(grid.patches[p].tile)[a];
        f(p, n, node);
      }
  }

 private:
  Patch<D> gone_;

  void occupy(Patch<D>& patch) {
    const auto some = static_cast<unsigned>(random() % 5);  // sparse, so that blocks differ
    patch.occupied = some == 0 ? 0 : random();
    for (unsigned k = 1; k < some; ++k) patch.occupied &= random();
  }
};

/// f(basis, bonded) for what decides the nodes of a patch.
template <class F>
void for_each_kind_of_grid(F&& f) {
  for (const BasisId basis : {basis_id<Linear>, basis_id<Gimp>})
    for (const bool bonded : {false, true}) f(basis, bonded);
}

}  // namespace mpm::testing
