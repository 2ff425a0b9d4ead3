#include "mpm/step/cell_loop.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void move_particles(Domain<D>& domain) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  auto& grid = domain.grid;
  const T dt(domain.time_step);
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    Patch<D>& patch = grid.patches[p];
    Body<D>& body = domain.body_of(patch);
    if (body.rigid) return;
    const NodeBlock<D> block = grid.block(p);
    auto left = T(1.0) < T(0.0);
    with_basis(grid, body, patch, [&](const auto& basis) {
      for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
        const auto velocity = vector_field(basis, cell, [&](int a) { return block.velocity(a); });
        for_each_group(cell, [&](const LaneRows<W>& rows) {
          const auto w = basis.weights(local_position(grid, body, cell, rows));
          for (int a = 0; a < D; ++a) {
            const T x = load(body.x(a), rows) + dt * velocity[static_cast<std::size_t>(a)].value(w);
            store(body.x(a), rows, x);
            const T local = grid.in_cells(x, a) - T(cell.cell[a]);
            left = left | (local < T(0.0)) | (local >= T(1.0));
          }
        });
      });
    });
    patch.left_cell = any(left);
  });
}

template void move_particles<2>(Domain<2>&);
template void move_particles<3>(Domain<3>&);

}  // namespace mpm
