#include "mpm/step/cell_loop.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void advance_particles(Domain<D>& domain) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  auto& grid = domain.grid;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    Body<D>& body = domain.body_of(patch);
    if (body.prescribed) return;
    const NodeBlock<D> block = grid.block(p);
    T kinetic(0.0), second_order(0.0);
    Vec<T, D> momentum = Vec<T, D>::zero();
    with_basis(grid, body, patch, [&](const auto& basis) {
      for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
        const auto increment = vector_field(basis, cell, [&](int a) { return block.force(a); });
        for_each_group(cell, [&](const LaneRows<W>& rows) {
          const auto w = basis.weights(local_position(grid, body, cell, rows));
          const T m = select(first_lanes<W>(rows.count), load(body.mass(), rows), T(0.0));
          T speed2(0.0), change2(0.0);
          for (int a = 0; a < D; ++a) {
            const T dv = increment[static_cast<std::size_t>(a)].value(w);
            const T v = load(body.v(a), rows) + dv;
            store(body.v(a), rows, v);
            momentum[a] += m * v;
            speed2 += v * v;
            change2 += dv * dv;
          }
          kinetic += m * speed2;
          second_order += m * change2;
        });
      });
    });
    PatchSums<D>& sums = domain.sums[p];
    sums.kinetic = 0.5 * sum(kinetic);
    sums.second_order = 0.5 * sum(second_order);
    for (int a = 0; a < D; ++a) sums.momentum[a] = sum(momentum[a]);
  });
}

template void advance_particles<2>(Domain<2>&);
template void advance_particles<3>(Domain<3>&);

}  // namespace mpm
