#include "mpm/step/loads.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

/// Velocity gradients, eqs. (18)-(20), of a patch's particles, handed to the material block by
/// block.
template <int D, class Field>
void update_patch(Domain<D>& domain, std::size_t p, bool forces_follow, Field&& field) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  const auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  Body<D>& body = domain.body_of(patch);
  if (body.rigid) return;
  const Material& material = domain.materials[static_cast<std::size_t>(body.material)];
  const StressSettings settings{domain.time_step, domain.time + domain.time_step, grid.cell_size,
                                material.viscosity, forces_follow};
  const T scale(domain.time_step / grid.cell_size);
  MaterialBlock<D> block;
  auto flush = [&] {
    update_block<T>(material, body.columns, body.at, block, settings, domain.sums[p].stress);
    block.count = 0;
  };
  with_basis(grid, body, patch, [&](const auto& basis) {
    for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
      const auto velocity = vector_field(basis, cell, field);
      for_each_group(cell, [&](const LaneRows<W>& rows) {
        if (block.count + W > static_cast<std::size_t>(block.capacity)) flush();
        const auto w = basis.weights(local_position(grid, body, cell, rows));
        for (int i = 0; i < D; ++i) {
          const Vec<T, D> gradient = velocity[static_cast<std::size_t>(i)].gradient(w);
          for (int j = 0; j < D; ++j)
            (scale * gradient[j]).store(&block.gradient[i][j][block.count]);
        }
        for (int k = 0; k < W; ++k)
          block.row[block.count + static_cast<std::size_t>(k)] = rows.row[k];
        block.count += static_cast<std::size_t>(
            rows.count);  // lanes past the end are overwritten by the next group
      });
    });
  });
  if (block.count > 0) flush();
  if (domain.has_loads()) carry_loads(domain, p, field);
}

template <int D>
void update_with_velocity(Domain<D>& domain, bool forces_follow) {
  domain.threads.for_each(domain.grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> nodes = domain.grid.block(p);
    update_patch(domain, p, forces_follow, [&](int a) { return nodes.velocity(a); });
  });
}

}  // namespace

template <int D>
void update_stress_first(Domain<D>& domain) {
  update_with_velocity(domain, true);
}

template <int D>
void update_stress_last(Domain<D>& domain) {
  update_with_velocity(domain, false);
}

template <int D>
void update_stress_remapped(Domain<D>& domain) {
  domain.threads.for_each(domain.grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> nodes = domain.grid.block(p);
    update_patch(domain, p, false, [&](int a) { return nodes.force(a); });
  });
}

template void update_stress_first<2>(Domain<2>&);
template void update_stress_first<3>(Domain<3>&);
template void update_stress_last<2>(Domain<2>&);
template void update_stress_last<3>(Domain<3>&);
template void update_stress_remapped<2>(Domain<2>&);
template void update_stress_remapped<3>(Domain<3>&);

}  // namespace mpm
