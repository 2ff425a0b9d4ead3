#include "mpm/run/start_affine.hpp"

#include <algorithm>
#include <cmath>

#include "mpm/comm/all_sums.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/step/affine_velocity.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

constexpr int lanes = 4;
using T = Batch<lanes>;

/// Of no interest here.
struct NoSums {
  T kinetic{0.0}, transferred{0.0};
};

/// The affine part from the nodes; returns the largest change [1/s].
template <int D, BasisModel B>
double take_affine(Domain<D>& domain, std::size_t p, const B& basis) {
  auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeRecords records = grid.block(p).records;
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(grid, pool);
  TakingAffine<T, D> affine(grid, pool);
  NoSums sums;
  double change = 0.0;
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    const auto nodes = field_of<B>(records.from(cell.first_node), stride);
    for_each_group<lanes>(cell, [&](const auto& rows) {
      T before[D * D];
      for (int k = 0; k < D * D; ++k) before[k] = load(pool.affine_part(k), rows);
      const Vec<T, D> xi = local_position(cell, rows);
      const auto w = weights_at(basis, xi);
      Vec<T, D> v;
      affine.take(nodes, rows, w, moments_at<B>(xi, w), T(0.0), v, sums);
      // Lanes behind the last particle repeat its row.
      for (int k = 0; k < D * D; ++k)
        for (int lane = 0; lane < lanes; ++lane)
          change = std::max(change, std::abs(before[k][lane] - pool.affine_part(k)[rows[lane]]));
    });
  });
  return change;
}

}  // namespace

template <int D>
void start_affine(Domain<D>& domain, int body) {
  if (!is_affine(domain.transfer)) return;
  const auto is_meant = [&](const Patch<D>& patch) {
    return domain.body_of(patch).deforms() && (body == all_bodies || patch.body == body);
  };
  for (const Patch<D>& patch : domain.grid.patches) {
    if (!is_meant(patch)) continue;
    ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch))
      for (int k = 0; k < D * D; ++k) pool.affine_part(k)[row] = Storage{0.0};
  }
  // Within a body the first pass is as good as the last; at its surface, where nodes have particles
  // on one side only, each takes away a part of the error.
  constexpr int most = 200;
  double first = 0.0;
  std::vector<double> changes;  // of each patch
  for (int k = 0; k < most; ++k) {
    map_momentum(domain);
    fold_momentum(domain);
    exchange_momentum(domain);
    find_velocities(domain);
    changes.assign(domain.grid.patches.size(), 0.0);
    domain.threads.for_each(changes.size(), [&](std::size_t p) {
      const Patch<D>& patch = domain.grid.patches[p];
      if (!is_meant(patch)) return;
      with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
        if constexpr (B::second_moment > 0.0) changes[p] = take_affine(domain, p, basis);
      });
    });
    const double change = all_max(*domain.grid.partition.comm,
                                  changes.empty() ? 0.0 : *std::ranges::max_element(changes));
    first = std::max(first, change);
    if (change <= 1e-14 * first) return;
  }
}

template void start_affine<2>(Domain<2>&, int);
template void start_affine<3>(Domain<3>&, int);

}  // namespace mpm
