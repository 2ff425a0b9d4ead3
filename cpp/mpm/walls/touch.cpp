#include "mpm/walls/touch.hpp"

#include "mpm/contact/set_back.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/walls/set_back.hpp"

namespace mpm {

template <int D>
void place_wall_springs(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  if (!grid.has_wall_springs) return;
  // A rigid body has no stress: it is held as a whole (rigid_bodies.cpp).
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    if (!patch.at_wall) return;
    scatter_wall_springs(grid, domain.body_of(patch), domain.pool_of(patch), patch, block);
    fold_wall_springs(grid, patch, block);
  });
}

template <int D>
void touch_walls(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  if (!grid.has_wall_springs) return;
  // Every patch that holds a node adds the same force there, from sums that all holders have:
  // nothing is exchanged after this.
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (patch.at_wall) domain.sums[p].wall_stored = push_from_walls(domain, patch, grid.block(p));
  });
}

template <int D>
void set_back_at_walls(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  if (!grid.has_wall_springs) return;
  SetBack& told = domain.contact.set_back;
  for (const Patch<D>& patch : grid.patches) {
    if (!domain.body_of(patch).deforms()) continue;
    ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch)) {
      double& share = pool.columns.component(pool.set_back)[row];
      const double before = share;
      for_each_wall_touch(grid, domain.body_of(patch), pool, row, [&](const WallTouch& touch) {
        share += (touch.overlap + beyond_overlap) / touch.half;
        told.most = std::max(told.most, touch.overlap * grid.cell_size);
      });
      if (before == 0.0 && share > 0.0) ++told.particles;
    }
  }
}

template void place_wall_springs<2>(Domain<2>&);
template void place_wall_springs<3>(Domain<3>&);
template void touch_walls<2>(Domain<2>&);
template void touch_walls<3>(Domain<3>&);
template void set_back_at_walls<2>(Domain<2>&);
template void set_back_at_walls<3>(Domain<3>&);

}  // namespace mpm
