#include "mpm/schedule/cell_loop.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/volume_averaging.hpp"

namespace mpm {
namespace {

/// What forces take off a particle's stress: q, and by how much its mean stress is above the cell's
/// mean by volume. Of the stress in the plane in 2D, as that alone works on the change of volume.
template <int D>
void average_patch(const TileGrid<D>& grid, ParticlePool<D>& pool, const Patch<D>& patch) {
  const Averaged<D> takes_part(pool);
  double* const pressure = pool.columns.component(pool.at.force_pressure);
  const int at = pool.at.viscosity_pressure;
  const double* const q = at >= 0 ? pool.columns.component(at) : nullptr;
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    double volume = 0.0, mean = 0.0;
    for (std::uint32_t k = 0; k < cell.count; ++k) {
      const std::uint32_t row = cell.rows[k];
      double stress = 0.0;
      for (int a = 0; a < D; ++a) stress += pool.stress(a)[row];
      pressure[row] = stress / D;  // positive in tension, until the mean is known
      if (!takes_part(row)) continue;
      volume += pool.volume()[row];
      mean += pool.volume()[row] * (stress / D - (q ? q[row] : 0.0));
    }
    for (std::uint32_t k = 0; k < cell.count; ++k) {
      const std::uint32_t row = cell.rows[k];
      if (takes_part(row))
        pressure[row] -= mean / volume;
      else
        pressure[row] = q ? q[row] : 0.0;
    }
  });
}

}  // namespace

template <int D>
void average_pressure(Domain<D>& domain) {
  if (!domain.averages_volume()) return;
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (domain.material_of(patch).averages_volume)
      average_patch(domain.grid, domain.pool_of(patch), patch);
  });
}

template void average_pressure<2>(Domain<2>&);
template void average_pressure<3>(Domain<3>&);

}  // namespace mpm
