#include "mpm/loads/carry_loads.hpp"
#include "mpm/step/move.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/volume_averaging.hpp"

namespace mpm {
namespace {

/// The means of a cell, of gradients found as those of the particles are.
template <int W, int straining_at, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] CellMean<D> mean_of_cell(const ParticlePool<D>& pool,
                                                         const CellRange<D>& cell,
                                                         const Field<B, D>& nodes, const B& basis,
                                                         const LocalPosition<D>& local_position,
                                                         double scale, bool at_end) {
  const Averaged<D> takes_part(pool);
  CellMean<D> mean;
  for_each_group<W>(cell, [&](const auto& rows) {
    const auto gradients =
        nodes.template gradients<straining_at>(weights_at(basis, local_position(cell, rows)));
    double lanes[D][D][W];
    unrolled<D>([&](auto i) {
      unrolled<D>([&](auto j) { (Batch<W>(scale) * gradients[i][j]).store(lanes[i][j]); });
    });
    for (int k = 0; k < rows.count; ++k) {
      if (!takes_part(rows[k])) continue;
      Mat<double, D> gradient;
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) gradient[i][j] = lanes[i][j][k];
      mean.add(pool.volume()[rows[k]], gradient, at_end);
    }
  });
  mean.finish();
  return mean;
}

/// Time over which the velocities strain [s].
// USF: the way here took the step before; in the first step there has been none.
template <int D>
double duration_of(const Domain<D>& domain, bool forces_follow) {
  return forces_follow ? domain.step_before : domain.time_step;
}

template <int D>
StressSettings settings_of(const Domain<D>& domain, const Material& material, bool forces_follow) {
  const double duration = duration_of(domain, forces_follow);
  return {duration > 0.0 ? duration : domain.time_step, domain.time + domain.time_step,
          domain.grid.cell_size, material.viscosity, forces_follow};
}

/// Update the particles of a block, and empty it. What averaging adds to their strains does its
/// work with the stress that the nodal forces use.
template <int D>
void update_and_empty(const Material& material, ParticlePool<D>& pool, MaterialBlock<D>& block,
                      const StressSettings& settings, const StrainBeyond<D>& beyond,
                      StressSums& sums) {
  const bool averages = material.averages_volume;
  if (averages && !settings.forces_follow) sums.averaging += beyond.work(pool, block);
  update_block<Batch<native_lanes>>(material, pool.columns, pool.at, block, settings, sums);
  if (averages && settings.forces_follow) sums.averaging += beyond.work(pool, block);
  block.count = 0;
}

/// Velocity gradients, eqs. (18)-(20), of a patch's particles, handed to the material block by
/// block. The nodal velocity that strains is the vector at number `straining_at` of the records;
/// with `moves` the particles move as well, eq. (16). L dt is handed on whole: the material refers
/// it to the middle of the step and splits it into strain, eq. (18), and vorticity, eq. (19)
/// (materials/jaumann.hpp). With `forces_follow` (USF) the velocities have brought the particles
/// here, and L is on the configuration at the end of what it strains (decision 0047).
template <int W, bool moves, int straining_at, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void update_patch(Domain<D>& domain, std::size_t p, const B& basis,
                                                  bool forces_follow) {
  using T = Batch<W>;
  const auto& grid = domain.grid;
  Patch<D>& patch = domain.grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  // Before particles move: the pieces go with L at the positions that the gradients belong to.
  const double duration = duration_of(domain, forces_follow);
  if (domain.has_loads()) carry_loads<straining_at>(domain, p, duration);
  const Material& material = domain.material_of(patch);
  const StressSettings settings = settings_of(domain, material, forces_follow);
  const NodeRecords records = domain.grid.block(p).records;
  const NodeStrides<D> stride(patch.shape);
  // Gradients come with respect to xi, in cells: 1 / h of eq. (20) and dt of eqs. (18)-(19) in one.
  const T scale(duration / grid.cell_size);
  const LocalPosition<D> local_position(grid, pool);
  Moving<T, D> moving(grid, pool, domain.time_step);
  MaterialBlock<D> block;
  // Blocks of up to 128 across cells, in full registers however few particles a cell has; one
  // indirect call for each part of the material and block (material_block.hpp). No particle's
  // result depends on its neighbours in the lanes (decision 0026).
  const bool averages = material.averages_volume;
  const Averaged<D> takes_part(pool);
  StrainBeyond<D> beyond;
  StressSums& sums = domain.sums[p].stress;
  auto flush = [&] { update_and_empty(material, pool, block, settings, beyond, sums); };
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    const auto nodes = field_of<B>(records.from(cell.first_node), stride);
    CellMean<D> mean;
    if (averages)
      mean = mean_of_cell<W, straining_at>(pool, cell, nodes, basis, local_position,
                                           duration / grid.cell_size, forces_follow);
    for_each_group<W>(cell, [&](const auto& rows) {
      // Whole registers are stored, so W places have to be free.
      if (block.count + W > static_cast<std::size_t>(block.capacity)) flush();
      const auto w = weights_at(basis, local_position(cell, rows));
      const auto gradients = nodes.template gradients<straining_at>(w);
      // [i][j] is dv_i / dx_j dt: rows are components, columns the axes of derivation, as in eqs.
      // (18)-(19).
      unrolled<D>([&](auto i) {
        unrolled<D>(
            [&](auto j) { (scale * gradients[i][j]).store(block.gradient[i][j] + block.count); });
      });
      unrolled<W>([&](auto k) { block.row[block.count + k] = rows[k]; });
      if (averages)
        average_gradients(block, block.count, rows.count, mean, takes_part, forces_follow, beyond);
      // Lanes past the end are overwritten by the next group.
      block.count += static_cast<std::size_t>(rows.count);
      // The velocity of the advanced nodes, not that which strains: in MUSL these are two. x is not
      // read again in this stage, the weights being those of before.
      if constexpr (moves) moving.move(cell, rows, nodes, w);
    });
  });
  if (block.count > 0) flush();
  // The power of the forces of this step, as long as they act.
  if (forces_follow && duration > 0.0)
    for (double* const work : {&sums.force_power, &sums.averaging})
      *work *= domain.time_step / duration;
  if constexpr (moves) moving.write(patch, domain.sums[p]);
}

template <bool moves, int straining_at, int D>
void update(Domain<D>& domain, bool forces_follow) {
  // A rigid motion strains nothing.
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    with_basis_and_lanes(
        domain.grid, domain.body_of(patch), patch, [&](const auto& basis, auto lanes) {
          update_patch<lanes, moves, straining_at>(domain, p, basis, forces_follow);
        });
  });
}

}  // namespace

template <int D>
void update_stress_first(Domain<D>& domain) {
  // Velocities of the start of the step; its forces use the stress made here, and so does the term
  // P of the ledger.
  update<false, velocity_at>(domain, true);
}

template <int D>
void update_stress_last(Domain<D>& domain) {
  // Nodes have been advanced: v_i + dv_i. The forces have used the stress before.
  update<false, velocity_at>(domain, false);
}

template <int D>
void update_stress_remapped(Domain<D>& domain) {
  update<false, remapped_at>(domain, false);
}

template <int D>
void update_stress_last_and_move(Domain<D>& domain) {
  update<true, velocity_at>(domain, false);
}

template <int D>
void update_stress_remapped_and_move(Domain<D>& domain) {
  update<true, remapped_at>(domain, false);
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
