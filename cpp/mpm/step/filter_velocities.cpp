// XPIC(k) of Hammerquist & Nairn (2017): what particles' velocities have that the grid does not
// see, u = (I - S S+)^k V, with S+ the map to velocities of nodes, eqs. (2)-(3), and S the way
// back.
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {
namespace {

/// First component of r_j: of r_0 = V that of the velocity.
template <int D>
int column_of(const ParticlePool<D>& pool, int j) {
  return j == 0 ? pool.at.velocity : pool.unseen;
}

/// S+ r_j up to the sums over patches: mass and momentum with the velocities r_j. Nodes have no
/// other use yet, so their mass and momentum are mapped again afterwards.
template <int D>
void map(Domain<D>& domain, int j) {
  auto& grid = domain.grid;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (patch.keeps) return;
    const NodeBlock<D> block = grid.block(p);
    const Body<D>& body = domain.body_of(patch);
    const ParticlePool<D>& pool = domain.pool_of(patch);
    // Of other bodies too, for the exchange reads every block.
    clear(block.records, block.count, half_record);
    if (!body.deforms()) return;
    with_basis_and_lanes(grid, body, patch, [&](const auto& basis, auto lanes) {
      scatter_by<Mapping<Flip>, gives_mass | gives_momentum, lanes>(
          basis, grid, pool, column_of(pool, j), patch, block.records);
    });
    fold_at_walls(grid, patch, block, momentum_at);
  });
  exchange_momentum(domain);
}

/// r_{j+1} = r_j - S S+ r_j for the particles of a patch. Lanes behind the last particle repeat its
/// row.
template <int W, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void subtract(Domain<D>& domain, std::size_t p, const B& basis,
                                              int j) {
  using T = Batch<W>;
  auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeRecords records = grid.block(p).records;
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(grid, pool);
  const Storage* before[D];
  Storage* after[D];
  for (int a = 0; a < D; ++a) {
    before[a] = pool.columns.rounded(column_of(pool, j) + a);
    after[a] = pool.unseen_velocity(a);
  }
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    const auto nodes = field_of<B>(records.from(cell.first_node), stride);
    for_each_group<W>(cell, [&](const auto& rows) {
      const auto w = weights_at(basis, local_position(cell, rows));
      const Vec<T, D> seen = nodes.template vector<velocity_at>(w);
      unrolled<D>([&](auto a)
                      MPM_INLINE { store(after[a], rows, load(before[a], rows) - seen[a]); });
    });
  });
}

/// r_{j+1} of all particles that deform, once the nodes have their sums.
template <int D>
void take(Domain<D>& domain, int j) {
  auto& grid = domain.grid;
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    momentum_to_velocity(grid, patch, block, velocity_at);
    reflect_at_walls(grid, patch, block, velocity_at);
    with_basis_and_lanes(grid, domain.body_of(patch), patch, [&](const auto& basis, auto lanes) {
      subtract<lanes>(domain, p, basis, j);
    });
  });
}

}  // namespace

template <int D>
void filter_velocities(Domain<D>& domain) {
  if (!filters_now(domain)) return;
  for (int j = 0; j < domain.filter_order; ++j) {
    map(domain, j);
    take(domain, j);
  }
}

template void filter_velocities<2>(Domain<2>&);
template void filter_velocities<3>(Domain<3>&);

}  // namespace mpm
