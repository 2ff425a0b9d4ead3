// Bodies on nodes of their own: places and deformation of the particles from the displacements of
// the nodes, (M1) of kept_nodes.hpp, and from its change, (M4), the stress.
#include "mpm/math/batch_math.hpp"
#include "mpm/math/inverse.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// With averaged pressures forces have worked on a part of the change of volume alone.
template <class T, int D>
class AveragedWork {
 public:
  AveragedWork(ParticlePool<D>& pool, bool averages)
      : pool_(pool),
        averages_(averages),
        q_(column(pool.at.viscosity_pressure)),
        taken_(column(pool.at.force_pressure)) {}

  /// Particles are deformed from `before` to F; ln J / J before is left for average_in_body().
  template <class Rows>
  void add(const Rows& rows, const Mat<T, D>& before, const Mat<T, D>& F) {
    if (!averages_) return;
    const T growth = log(determinant(F) / determinant(before));
    const T beyond = q_ ? load(taken_, rows) - load(q_, rows) : load(taken_, rows);
    not_done_ += of_valid(rows, load(pool_.volume(), rows) * beyond * growth);
    store(pool_.v(1), rows, growth);
  }
  /// Half of the work that the stress of the particles would have done more, by that at the start.
  double half_not_done() const { return 0.5 * sum(not_done_); }

 private:
  const double* column(int at) const { return at >= 0 ? pool_.columns.component(at) : nullptr; }

  ParticlePool<D>& pool_;
  bool averages_;
  const double *q_, *taken_;
  T not_done_ = T(0.0);
};

/// Between the pieces of what has failed nodes go anywhere: what they would turn inside out stays
/// as it was, and bears nothing.
template <class T, int D, class Rows>
void keep_upright(const ParticlePool<D>& pool, const Rows& rows, const Mat<T, D>& before,
                  Mat<T, D>& F) {
  constexpr double least_volume = 0.05;
  const T failed = load(pool.columns.component(pool.at.failed), rows);
  const auto stays = (failed > T(0.0)) & (determinant(F) < T(least_volume));
  unrolled<D * D>(
      [&](auto k) { F[k / D][k % D] = select(stays, before[k / D][k % D], F[k / D][k % D]); });
}

template <int W, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void update_patch(Domain<D>& domain, std::size_t p,
                                                  const B& basis) {
  using T = Batch<W>;
  TileGrid<D>& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  const Material& material = domain.material_of(patch);
  // The stress follows the forces, as the velocities that strain are those of the step. How much
  // particles are squeezed stands where their velocity does when somebody asks for it.
  const StressSettings settings{
      domain.time_step, domain.time_after, grid.cell_size, material.viscosity, false, pool.v(0)};
  const Nodes<half_record> displacements = grid.block(p).displacements;
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(grid, pool);
  const T per_cell_size(1.0 / grid.cell_size);
  AveragedWork<T, D> averaged(pool, domain.body_of(patch).averages);
  StressSums& sums = domain.sums[p].stress;
  MaterialBlock<D> block;
  const auto flush = [&] {
    update_block<Batch<native_lanes>>(material, pool.columns, pool.at, block, settings, sums);
    block.count = 0;
  };
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    const NodalField<D, B::nodes, half_record> nodes(
        displacements.from(cell.first_node + stride.to_first(B::before)), stride);
    for_each_group<W>(cell, [&](const auto& rows) {
      if (block.count + W > static_cast<std::size_t>(block.capacity)) flush();
      Vec<T, D> u;
      const auto gradients =
          nodes.template value_and_gradients<0>(weights_at(basis, local_position(cell, rows)), u);
      Mat<T, D> before, F, change;
      unrolled<D * D>([&](auto k) {
        constexpr int i = k / D, j = k % D;
        before[i][j] = load(pool.deformation_part(k), rows);
        F[i][j] = fma(per_cell_size, gradients[i][j], T(i == j ? 1.0 : 0.0));
      });
      if (pool.at.failed >= 0) keep_upright(pool, rows, before, F);
      unrolled<D * D>([&](auto k) {
        constexpr int i = k / D, j = k % D;
        change[i][j] = F[i][j] - before[i][j];
        store(pool.deformation_part(k), rows, F[i][j]);
      });
      const Mat<T, D> L = change * inverse_of(before);
      unrolled<D * D>([&](auto k) {
        constexpr int i = k / D, j = k % D;
        L[i][j].store(block.gradient[i][j] + block.count);
      });
      unrolled<D>([&](auto a) { store(pool.x(a), rows, load(pool.listed(a), rows) + u[a]); });
      averaged.add(rows, before, F);
      store(pool.v(0), rows, sqrt(largest_stretch_squared(inverse_of(F))));
      unrolled<W>([&](auto k) { block.row[block.count + k] = rows[k]; });
      block.count += static_cast<std::size_t>(rows.count);
    });
  });
  if (block.count > 0) flush();
  sums.internal -= averaged.half_not_done();
  // Half of the work that the new stress does in a step with these velocities: of the mean of the
  // stress and of that at the start there are the sums.
  const double mean = sums.internal + sums.plastic + sums.viscous + sums.damped + sums.bounded;
  domain.sums[p].kept_ahead -= mean - 0.5 * sums.force_power;
  domain.sums[p].kept_shift = -(domain.sums[p].force_work + sums.force_power);
}

}  // namespace

template <int D>
void update_in_body(Domain<D>& domain) {
  for_each_patch(domain, in_body, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    with_basis_and_lanes(domain.grid, domain.body_of(patch), patch,
                         [&]<BasisModel B>(const B& basis, auto lanes) {
                           if constexpr (B::nodes > 2) update_patch<lanes>(domain, p, basis);
                         });
  });
}

template void update_in_body<2>(Domain<2>&);
template void update_in_body<3>(Domain<3>&);

}  // namespace mpm
