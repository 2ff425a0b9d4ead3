#include "mpm/walls/absorb.hpp"

#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {

template <int D>
void place_dashpots(Domain<D>& domain) {
  auto& grid = domain.grid;
  if (!grid.walls.absorb()) return;
  // A rigid body has no waves: it feels no dashpots.
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    scatter_dashpots(grid, domain.body_of(patch), domain.pool_of(patch), patch, grid.block(p));
  });
}

template <int D>
void absorb_at_walls(Domain<D>& domain) {
  auto& grid = domain.grid;
  if (!grid.walls.absorb()) return;
  // Every patch that holds a node adds the same force there, from sums that all holders have:
  // nothing is exchanged after this.
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    add_dashpot_forces(grid.patches[p], grid.block(p), domain.gravity, domain.time_step);
  });
}

template void place_dashpots<2>(Domain<2>&);
template void place_dashpots<3>(Domain<3>&);
template void absorb_at_walls<2>(Domain<2>&);
template void absorb_at_walls<3>(Domain<3>&);

}  // namespace mpm
