#pragma once
// Particles at random over several tiles, in lists: three bodies, the first and the last of one
// material, in two pools.
#include <map>
#include <random>
#include <vector>

#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/make_body.hpp"

namespace mpm::testing {

template <int D>
struct Scattered {
  std::mt19937_64 random;
  Threads threads{2};
  TileGrid<D> grid;
  ListScratch<D> scratch;
  std::vector<Body<D>> bodies;
  std::vector<ParticlePool<D>> pools;
  Removed eroded, outflow;

  Scattered(unsigned seed, BasisId basis, bool bonded, std::size_t particles) : random(seed) {
    grid.cell_size = 0.5;
    grid.basis = basis;
    grid.bonded = bonded;
    grid.outflow_box.exist = true;  // so that there are the columns that particles which leave need
    for (int a = 0; a < D; ++a) {
      grid.outflow_box.lower[a] = -1e3;
      grid.outflow_box.upper[a] = 1e3;
    }
    const Material material =
        make_material({1.0, {"elastic", {{"E", 1.0}, {"nu", 0.2}}}, {}, {}, {}});
    for (int m = 0; m < 2; ++m) pools.push_back(make_pool(material, grid));
    const std::vector<double> at_rest(D, 0.0), volume{1.0};
    for (int b = 0; b < 3; ++b) {
      std::vector<double> x(particles * D);
      for (double& c : x) c = any(0.0, 6.0);
      bodies.push_back(make_body<D>("b", material, pools[0], x, at_rest, volume));
      bodies.back().material = b == 1 ? 1 : 0;
    }
    fill_pools(pools, {material, material}, bodies, grid.patches);
    for (ParticlePool<D>& pool : pools)
      for (std::uint32_t row = 0; row < pool.count(); ++row) pool.piece.push_back(row);
    build_cell_lists(grid, bodies, pools, threads, scratch);
  }
  double any(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  }
  ParticlePool<D>& pool_of(const Patch<D>& patch) { return pools[pool_number(bodies, patch.body)]; }
  /// Particles of about half the patches go elsewhere, by up to `way` [m]; some onto faces of
  /// cells.
  void move(double way) {
    for (Patch<D>& patch : grid.patches) {
      if (random() % 2 == 0) continue;
      patch.left_cell = true;
      ParticlePool<D>& pool = pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch))
        for (int a = 0; a < D; ++a) {
          double& x = pool.x(a)[row];
          x += any(-way, way);
          if (way > grid.cell_size && random() % 5 == 0)
            x = grid.cell_size * std::round(x / grid.cell_size);
        }
    }
  }
  /// Some of these patches fail for good.
  void fail_some() {
    for (const Patch<D>& patch : grid.patches)
      for (const std::uint32_t row : pool_of(patch).rows(patch))
        if (patch.left_cell && random() % 10 == 0)
          pool_of(patch).columns.component(pool_of(patch).at.failed)[row] =
              static_cast<double>(FailureAction::erode);
  }
  void update() { update_cell_lists(grid, bodies, pools, threads, scratch, &eroded, &outflow); }

  /// The number in its tile of the cell in which a place is, or CellMark::outside.
  int mark_of(const Patch<D>& patch, std::uint32_t row) {
    const Index<D> cell = grid.cell_of(pool_of(patch).position_of(row));
    if (grid.tile_of(cell) != patch.tile) return 255;
    Index<D> local = cell;
    for (std::size_t a = 0; a < D; ++a) local[a] -= grid.first_cell(patch.tile)[a];
    return Tile<D>::cell(local);
  }
};

}  // namespace mpm::testing
