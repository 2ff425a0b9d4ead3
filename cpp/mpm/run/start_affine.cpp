#include "mpm/run/start_affine.hpp"

#include <algorithm>
#include <cmath>

#include "mpm/comm/all_sums.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/step/affine_velocity.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

// Passes end at this change, over the largest spin or change of a pass: what is left is twice that,
// at the surface alone. Other fields than those of rigid motions take some seventy.
constexpr double small_change = 1e-11;
// Of a gradient by nodes, over the velocity by the edge of a cell; a node sums a few hundred terms.
constexpr double rounding_of_nodes = 1e-14;
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

/// Begin with the affine part of a rigid motion, the body's own: of bodies that turn and fly that
/// is the answer, which passes find to rounding only after a hundred. Returns the largest spin
/// [1/s].
template <int D, class Meant>
double begin_with_spins(Domain<D>& domain, Meant&& is_meant, double& fastest) {
  const auto all = [&](auto&& f) {
    for (const Patch<D>& patch : domain.grid.patches) {
      if (!is_meant(patch.body)) continue;
      ParticlePool<D>& pool = domain.pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch)) f(pool, row, patch.body);
    }
  };
  all([&](ParticlePool<D>& pool, std::uint32_t row, int) {
    for (int k = 0; k < D * D; ++k) pool.affine_part(k)[row] = Storage{0.0};
    for (int a = 0; a < D; ++a) fastest = std::max(fastest, std::abs(double{pool.v(a)[row]}));
  });
  std::vector<std::size_t> numbers(domain.bodies.size());
  for (std::size_t b = 0; b < numbers.size(); ++b) numbers[b] = b;
  std::vector<PartSums> parts = part_sums(domain, Grouping{numbers, numbers.size()});
  std::vector<Vector3> spins(parts.size(), Vector3::zero());
  double largest = 0.0;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    if (!is_meant(static_cast<int>(b))) continue;
    // Without that of the affine part, which has no angular momentum yet.
    const double own = 2.0 * domain.grid.affine_moment() * parts[b].mass;
    for (int k = 0; k < 3; ++k) parts[b].inertia[k][k] -= own;
    spins[b] = spin_of(parts[b], D);
    largest = std::max(largest, norm(spins[b]));
  }
  all([&](ParticlePool<D>& pool, std::uint32_t row, int body) {
    const Vector3& w = spins[static_cast<std::size_t>(body)];
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        // Column j of w x: w x e_j.
        pool.affine_part(D * i + j)[row] =
            static_cast<Storage>(i == j ? 0.0 : ((i - j + 3) % 3 == 1 ? 1.0 : -1.0) * w[3 - i - j]);
  });
  return largest;
}

}  // namespace

template <int D>
void start_affine(Domain<D>& domain, const std::vector<bool>& bodies) {
  if (!is_affine(domain.transfer)) return;
  const auto is_meant = [&](int body) {
    const Body<D>& of = domain.body_at(body);
    return of.deforms() && !of.keeps_nodes() &&
           (bodies.empty() || bodies[static_cast<std::size_t>(body)]);
  };
  double fastest = 0.0;
  double largest = begin_with_spins(domain, is_meant, fastest);
  Comm& comm = *domain.grid.partition.comm;
  // Of what the nodes round nothing is left to gain.
  const double rounding = rounding_of_nodes * all_max(comm, fastest) / domain.grid.cell_size;
  // Within a body the first pass is as good as the last; at its surface, where nodes have particles
  // on one side only, each takes away a part of the error.
  constexpr int most = 200;
  std::vector<double> changes;  // of each patch
  for (int k = 0; k < most; ++k) {
    map_momentum(domain);
    fold_momentum(domain);
    exchange_momentum(domain);
    find_velocities(domain);
    changes.assign(domain.grid.patches.size(), 0.0);
    domain.threads.for_each(changes.size(), [&](std::size_t p) {
      const Patch<D>& patch = domain.grid.patches[p];
      if (!is_meant(patch.body)) return;
      with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
        if constexpr (B::second_moment > 0.0) changes[p] = take_affine(domain, p, basis);
      });
    });
    const double change = all_max(comm, changes.empty() ? 0.0 : *std::ranges::max_element(changes));
    largest = std::max(largest, change);
    if (change <= std::max(small_change * largest, rounding)) return;
  }
}

template void start_affine<2>(Domain<2>&, const std::vector<bool>&);
template void start_affine<3>(Domain<3>&, const std::vector<bool>&);

}  // namespace mpm
