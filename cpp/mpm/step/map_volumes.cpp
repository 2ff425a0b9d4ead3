// The volumes of matter that flows, mapped to the nodes with the functions of the momentum:
// V_i = sum V_p N_ip (step/flowing_matter.hpp).
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

/// Summed aside as if volumes were masses at rest, then put beside the forces.
template <int W, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void map_patch(Domain<D>& domain, const Patch<D>& patch,
                                               const NodeBlock<D>& block, const B& basis) {
  using T = Batch<W>;
  const TileGrid<D>& grid = domain.grid;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  constexpr unsigned what = gives_mass | gives_momentum;
  alignas(cache_line) double aside[BlockShape<D>::nodes_max * half_record];
  const HalfRecords volumes{aside};
  clear(volumes, block.count, half_record);
  const LocalPosition<D> local_position(grid, pool);
  DoubleBuffer<Mapping<Flip>, what, D, B, half_record> cells(NodeStrides<D>(patch.shape), volumes);
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    cells.begin(cell);
    for_each_group<W>(cell, [&](const auto& rows) {
      auto& particles = cells.next();
      particles.add(load(pool.volume(), rows), Vec<T, D>::zero());
      particles.place(weights_at(basis, local_position(cell, rows)), rows.count);
    });
    cells.end();
  });
  cells.finish();
  for (int n = 0; n < block.count; ++n) block.records[n][volume_at] = volumes[n][mass_at];
}

}  // namespace

template <int D>
void map_volumes(Domain<D>& domain) {
  for_each_flowing_patch(domain, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    with_basis_and_lanes(domain.grid, domain.body_of(patch), patch,
                         [&]<BasisModel B>(const B& basis, auto lanes) {
                           if constexpr (B::second_moment > 0.0)
                             map_patch<lanes>(domain, patch, block, basis);
                         });
  });
}

template void map_volumes<2>(Domain<2>&);
template void map_volumes<3>(Domain<3>&);

}  // namespace mpm
