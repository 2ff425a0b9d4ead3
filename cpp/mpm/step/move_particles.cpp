#include "mpm/step/move.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {

template <int D>
void move_particles(Domain<D>& domain) {
  auto& grid = domain.grid;
  for_each_patch(domain, deformable, [&](std::size_t p) {
    Patch<D>& patch = grid.patches[p];
    const Body<D>& body = domain.body_of(patch);
    ParticlePool<D>& pool = domain.pool_of(patch);
    const NodeBlock<D> block = grid.block(p);
    const LocalPosition<D> local_position(grid, pool);
    with_basis_and_lanes(grid, body, patch, [&]<BasisModel B>(const B& basis, auto lanes) {
      Moving<Batch<lanes>, D> moving(grid, pool, domain.time_step);
      const NodeStrides<D> stride(patch.shape);
      for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
        // Fields are made again only in the schemes that are not fused; elsewhere `Moving` uses
        // those at hand.
        const auto nodes = field_of<B>(block.records.from(cell.first_node), stride);
        for_each_group<lanes>(cell, [&](const auto& rows) {
          moving.move(cell, rows, nodes, weights_at(basis, local_position(cell, rows)));
        });
      });
      moving.write(patch, domain.sums[p]);
    });
  });
}

template void move_particles<2>(Domain<2>&);
template void move_particles<3>(Domain<3>&);

}  // namespace mpm
