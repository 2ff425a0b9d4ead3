// Gases with an affine transfer are heated by the work of the very force that acts on the nodes
// (step/flowing_matter.hpp): dU_p = dt V_p (sigma_p - q_p 1) : sum (v_i + dv_i / 2) (x) grad N_ip,
// with the velocities that strain, so that particles lose to the nodes just what these gain.
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

template <int W, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void heat_patch(Domain<D>& domain, std::size_t p, const B& basis) {
  using T = Batch<W>;
  TileGrid<D>& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeRecords records = grid.block(p).records;
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(grid, pool);
  const auto column = [&](int at) { return at >= 0 ? pool.columns.component(at) : nullptr; };
  const MaterialColumns& at = pool.at;
  double *const energy = column(at.energy), *const recoverable = column(at.recoverable);
  // What the nodal forces take off the stress (schedule/scatter.hpp).
  const double* const q =
      column(at.force_pressure >= 0 ? at.force_pressure : at.viscosity_pressure);
  // Gradients come in cells.
  const T scale(domain.time_step / grid.cell_size), density(domain.material_of(patch).density);
  T works(0.0), viscous_works(0.0);
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    const auto nodes = field_of<B>(records.from(cell.first_node), stride);
    for_each_group<W>(cell, [&](const auto& rows) {
      const auto w = weights_at(basis, local_position(cell, rows));
      const auto end = nodes.template gradients<velocity_at>(w),
                 change = nodes.template gradients<increment_at>(w);
      T power(0.0), dilation(0.0);
      unrolled<D>([&](auto a) {
        unrolled<D>([&](auto b) {
          const T middle = fma(T(-0.5), change[a][b], end[a][b]);
          power = fma(load(pool.stress(Sym<T, D>::index(a, b)), rows), middle, power);
          if constexpr (a == b) dilation += middle;
        });
      });
      const T all = load(pool.mass(), rows), per_volume = density / all;
      const T done = scale * load(pool.volume(), rows), work = done * power;
      const T viscous = q ? -(done * load(q, rows) * dilation) : T(0.0);
      store(energy, rows, fma(work + viscous, per_volume, load(energy, rows)));
      if (recoverable) store(recoverable, rows, fma(work, per_volume, load(recoverable, rows)));
      const T valid = of_valid(rows, all) / all;  // 0 in lanes behind the last particle
      works = fma(valid, work, works);
      viscous_works = fma(valid, viscous, viscous_works);
    });
  });
  StressSums& sums = domain.sums[p].stress;
  sums.internal += sum(works);
  sums.viscous += sum(viscous_works);
}

}  // namespace

template <int D>
void heat_gases(Domain<D>& domain) {
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (domain.pool_of(patch).at.heat_owed < 0) return;
    with_basis_and_lanes(domain.grid, domain.body_of(patch), patch,
                         [&]<BasisModel B>(const B& basis, auto lanes) {
                           if constexpr (B::second_moment > 0.0)
                             heat_patch<lanes>(domain, p, basis);
                         });
  });
}

template void heat_gases<2>(Domain<2>&);
template void heat_gases<3>(Domain<3>&);

}  // namespace mpm
