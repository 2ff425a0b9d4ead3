#include "mpm/step/mirror.hpp"
#include "mpm/step/prescribed_bodies.hpp"
#include "mpm/step/scatter_momentum.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void map_momentum(Domain<D>& domain) {
  auto& grid = domain.grid;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    clear_fields(block, 0, 1 + D);
    const Body<D>& body = domain.body_of(patch);
    if (body.prescribed && !patch.in_contact) return;  // Nobody asks for its nodes.
    with_basis(grid, body, patch, [&](const auto& basis) {
      scatter_momentum<true>(basis, grid, body, patch, block.mass(),
                             [&](int a) { return block.velocity(a); });
    });
    fold_at_walls(grid, patch, block.mass(), [&](int a) { return block.velocity(a); });
  });
  grid.sum_shared_nodes(domain.threads, 0, 1 + D);
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> block = grid.block(p);
    const auto velocity = [&](int a) { return block.velocity(a); };
    const Body<D>& body = domain.body_of(grid.patches[p]);
    if (body.prescribed) {
      set_rigid_velocity(grid, grid.patches[p], body.motion->before, velocity);
      return;
    }
    momentum_to_velocity(grid, grid.patches[p], block, velocity);
    reflect_at_walls(grid, grid.patches[p], velocity);
  });
}

template void map_momentum<2>(Domain<2>&);
template void map_momentum<3>(Domain<3>&);

}  // namespace mpm
