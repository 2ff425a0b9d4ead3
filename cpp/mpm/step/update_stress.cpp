#include "mpm/step/loads.hpp"
#include "mpm/step/move.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

/// Velocity gradients, eqs. (18)-(20), of a patch's particles, handed to the material block by
/// block. `field(a)` is the nodal velocity that strains; with `moves` the particles move as well,
/// eq. (16).
template <bool moves, int D, class Field>
[[gnu::flatten]] void update_patch(Domain<D>& domain, std::size_t p, bool forces_follow,
                                   Field&& field) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  const auto& grid = domain.grid;
  Patch<D>& patch = domain.grid.patches[p];
  Body<D>& body = domain.body_of(patch);
  if (body.rigid) return;
  if (domain.has_loads()) carry_loads(domain, p, field);
  const Material& material = domain.materials[static_cast<std::size_t>(body.material)];
  const StressSettings settings{domain.time_step, domain.time + domain.time_step, grid.cell_size,
                                material.viscosity, forces_follow};
  const NodeBlock<D> nodes = domain.grid.block(p);
  const T scale(domain.time_step / grid.cell_size);
  const LocalPosition<D> local_position(grid, body);
  Moving<D> moving(grid, body, domain.time_step);
  MaterialBlock<D> block;
  auto flush = [&] {
    update_block<T>(material, body.columns, body.at, block, settings, domain.sums[p].stress);
    block.count = 0;
  };
  with_basis(grid, body, patch, [&](const auto& basis) {
    for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
      const auto straining = vector_field(basis, cell, field);
      [[maybe_unused]] const auto velocity =
          vector_field(basis, cell, [&](int a) { return nodes.velocity(a); });
      for_each_group(cell, [&](const auto& rows) {
        if (block.count + W > static_cast<std::size_t>(block.capacity)) flush();
        const auto w = basis.weights(local_position(cell, rows));
        unrolled<D>([&](auto i) {
          const Vec<T, D> gradient = straining[i].gradient(w);
          unrolled<D>(
              [&](auto j) { (scale * gradient[j]).store(block.gradient[i][j] + block.count); });
        });
        unrolled<W>([&](auto k) { block.row[block.count + k] = rows[k]; });
        // Lanes past the end are overwritten by the next group.
        block.count += static_cast<std::size_t>(rows.count);
        if constexpr (moves) moving.move(cell, rows, velocity, w);
      });
    });
  });
  if (block.count > 0) flush();
  if constexpr (moves) patch.left_cell = moving.left_cell();
}

template <bool moves, int D>
void update_with_velocity(Domain<D>& domain, bool forces_follow) {
  domain.threads.for_each(domain.grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> nodes = domain.grid.block(p);
    update_patch<moves>(domain, p, forces_follow, [&](int a) { return nodes.velocity(a); });
  });
}

template <bool moves, int D>
void update_with_remapped(Domain<D>& domain) {
  domain.threads.for_each(domain.grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> nodes = domain.grid.block(p);
    update_patch<moves>(domain, p, false, [&](int a) { return nodes.force(a); });
  });
}

}  // namespace

template <int D>
void update_stress_first(Domain<D>& domain) {
  update_with_velocity<false>(domain, true);
}

template <int D>
void update_stress_last(Domain<D>& domain) {
  update_with_velocity<false>(domain, false);
}

template <int D>
void update_stress_remapped(Domain<D>& domain) {
  update_with_remapped<false>(domain);
}

template <int D>
void update_stress_last_and_move(Domain<D>& domain) {
  update_with_velocity<true>(domain, false);
}

template <int D>
void update_stress_remapped_and_move(Domain<D>& domain) {
  update_with_remapped<true>(domain);
}

template void update_stress_first<2>(Domain<2>&);
template void update_stress_first<3>(Domain<3>&);
template void update_stress_last<2>(Domain<2>&);
template void update_stress_last<3>(Domain<3>&);
template void update_stress_remapped<2>(Domain<2>&);
template void update_stress_remapped<3>(Domain<3>&);
template void update_stress_last_and_move<2>(Domain<2>&);
template void update_stress_last_and_move<3>(Domain<3>&);
template void update_stress_remapped_and_move<2>(Domain<2>&);
template void update_stress_remapped_and_move<3>(Domain<3>&);

}  // namespace mpm
