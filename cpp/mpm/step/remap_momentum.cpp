#include "mpm/step/mirror.hpp"
#include "mpm/step/scatter_momentum.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void remap_momentum(Domain<D>& domain) {
  auto& grid = domain.grid;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    clear_fields(block, 1 + D, 1 + 2 * D);
    const Body<D>& body = domain.body_of(patch);
    if (body.prescribed) return;
    with_basis(grid, body, patch, [&](const auto& basis) {
      scatter_momentum<false>(basis, grid, body, patch, block.mass(),
                              [&](int a) { return block.force(a); });
    });
    fold_at_walls<D>(grid, patch, nullptr, [&](int a) { return block.force(a); });
  });
  grid.sum_shared_nodes(domain.threads, 1 + D, 1 + 2 * D);
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> block = grid.block(p);
    const auto velocity = [&](int a) { return block.force(a); };
    if (domain.body_of(grid.patches[p]).prescribed) {
      for (int a = 0; a < D; ++a) std::copy_n(block.velocity(a), block.stride, block.force(a));
      return;
    }
    momentum_to_velocity(grid, grid.patches[p], block, velocity);
    reflect_at_walls(grid, grid.patches[p], velocity);
  });
}

template void remap_momentum<2>(Domain<2>&);
template void remap_momentum<3>(Domain<3>&);

}  // namespace mpm
