// Bodies on nodes of their own that average their pressures, as plastic ones do once they flow
// (run/average_what_flows.hpp) and others where `volume_averaging` asks for it: their mean stress
// is projected onto the functions of the nodes. Points between nodes have more volumes than nodes
// can tell apart, and what nodes cannot tell apart is noise of the pressure. With s_p the mean
// normal stress (in the plane in 2D), pi_p = V_p s_p / m_p and
//   (R pi)_p = sum_i N_ip (sum_q m_q N_iq pi_q) / m_i                                       (P1)
// forces use in place of s_p
//   (m_p / V_p) [(1 - b) pi_p + b (R pi)_p]                                                 (P2)
// The material knows nothing of it. R is self-adjoint under the masses: where pi is linear in ln J
// these are the forces of the energy sum m_p pi_p [(1 - b) ln J_p + b (R ln J)_p] / 2. The share
// 1 - b keeps each particle's own volume. Of pressures that vary over cells R takes (k h)^2 / 4.
#include <algorithm>
#include <cmath>

#include "mpm/followers/follow.hpp"
#include "mpm/grid/halo.hpp"
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/flip.hpp"
#include "mpm/step/transfer/mapping.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {
namespace {

/// b. Plastic flow does not bring a volume back to what it was: with .95 the volumes of a block
/// that is pressed to a third come to .85 to 1.1, and it is a tenth too weak; with .5 .98 to 1.
double projected_share(const Material& material) { return material.yields() ? 0.5 : 0.95; }

/// The last of the numbers beside the displacements of a node, which is free for a sum.
constexpr int projected_at = half_record - 1;

/// Mean normal stress of particles.
template <class T, int D, class Rows>
T mean_stress(const ParticlePool<D>& pool, const Rows& rows) {
  T sum = load(pool.stress(0), rows);
  unrolled<D - 1>([&](auto a) { sum += load(pool.stress(a + 1), rows); });
  return T(1.0 / D) * sum;
}

/// sum V_p s_p N_ip of a patch's particles, as if these were masses.
template <int W, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void map_pressure(Domain<D>& domain, const Patch<D>& patch,
                                                  const HalfRecords& nodes, const B& basis) {
  using T = Batch<W>;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const LocalPosition<D> local_position(domain.grid, pool);
  DoubleBuffer<Mapping<Flip>, gives_mass | gives_momentum, D, B, half_record> cells(
      NodeStrides<D>(patch.shape), nodes);
  for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
    cells.begin(cell);
    for_each_group<W>(cell, [&](const auto& rows) {
      auto& to = cells.next();
      to.add(load(pool.volume(), rows) * mean_stress<T>(pool, rows), Vec<T, D>::zero());
      to.place(weights_at(basis, local_position(cell, rows)), rows.count);
    });
    cells.end();
  });
  cells.finish();
}

/// What forces take off the stress of a patch's particles, by sums over masses at the nodes; and
/// the second half of what this takes of their work, over the change of ln J.
template <int W, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] double take_projected(Domain<D>& domain, const Patch<D>& patch,
                                                      const HalfRecords& nodes, const B& basis) {
  using T = Batch<W>;
  ParticlePool<D>& pool = domain.pool_of(patch);
  const int at = pool.at.viscosity_pressure;
  const double* const q = at >= 0 ? pool.columns.component(at) : nullptr;
  double* const taken = pool.columns.component(pool.at.force_pressure);
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(domain.grid, pool);
  const T share(projected_share(domain.material_of(patch)));
  T work(0.0);
  for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
    const NodalField<D, B::nodes, half_record> around(
        nodes.from(cell.first_node + stride.to_first(B::before)), stride);
    for_each_group<W>(cell, [&](const auto& rows) {
      const T mean =
          around.template value<projected_at>(weights_at(basis, local_position(cell, rows)));
      const T volume = load(pool.volume(), rows);
      const T beyond =
          share * (mean_stress<T>(pool, rows) - load(pool.mass(), rows) * mean / volume);
      work += of_valid(rows, volume * beyond * load(pool.v(1), rows));
      store(taken, rows, q ? load(q, rows) + beyond : beyond);
    });
  });
  return 0.5 * sum(work);
}

/// f(p) for the patches of bodies on nodes of their own that average.
template <int D, class F>
void for_each_averaging(Domain<D>& domain, F&& f) {
  for_each_patch(domain, in_body, [&](std::size_t p) {
    if (domain.body_of(domain.grid.patches[p]).averages) f(p);
  });
}

/// Forces use the stress of a patch's particles as it is, less their viscous pressure.
template <int D>
void leave_stress(Domain<D>& domain, const Patch<D>& patch) {
  ParticlePool<D>& pool = domain.pool_of(patch);
  const int at = pool.at.viscosity_pressure;
  const double* const q = at >= 0 ? pool.columns.component(at) : nullptr;
  double* const taken = pool.columns.component(pool.at.force_pressure);
  for (const std::uint32_t row : pool.rows(patch)) taken[row] = q ? q[row] : 0.0;
}

/// That of bodies that could average and do not, where there is such a pressure in each step.
template <int D>
void leave_others(Domain<D>& domain) {
  for_each_patch(domain, in_body, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const MaterialColumns& at = domain.pool_of(patch).at;
    if (!domain.body_of(patch).averages && at.force_pressure >= 0 && at.viscosity_pressure >= 0)
      leave_stress(domain, patch);
  });
}

/// What forces take off the stress of all of them; with `counts` the work is counted.
template <int D>
void project_pressure(Domain<D>& domain, bool counts) {
  if (!domain.averages_volume()) return;
  leave_others(domain);
  if (std::ranges::none_of(domain.bodies, &Body<D>::averages)) return;
  TileGrid<D>& grid = domain.grid;
  for_each_averaging(domain, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    alignas(cache_line) double aside[BlockShape<D>::nodes_max * half_record];
    const HalfRecords sums{aside};
    clear(sums, block.count, half_record);
    with_basis_and_lanes(grid, domain.body_of(patch), patch,
                         [&]<BasisModel B>(const B& basis, auto lanes) {
                           if constexpr (B::nodes > 2)
                             map_pressure<lanes>(domain, patch, sums, basis);
                         });
    for (int n = 0; n < block.count; ++n) block.displacements[n][projected_at] = sums[n][mass_at];
    for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>&) {
      block.displacements[image][projected_at] += block.displacements[node][projected_at];
      block.displacements[node][projected_at] = 0.0;
    });
  });
  exchange_and_sum_kept(grid, domain.threads, projected_at);
  give_number_to_leading(domain, projected_at);
  for_each_averaging(domain, [&](std::size_t p) {
    const NodeBlock<D> block = grid.block(p);
    for (int n = 0; n < block.count; ++n)
      if (const double m = block.records[n][mass_at]; m > 0.0)
        block.displacements[n][projected_at] /= m;
  });
  take_number_from_leading(domain, projected_at);
  for_each_averaging(domain, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>&) {
      block.displacements[node][projected_at] = block.displacements[image][projected_at];
    });
    PatchSums<D>& sums = domain.sums[p];
    with_basis_and_lanes(
        grid, domain.body_of(patch), patch, [&]<BasisModel B>(const B& basis, auto lanes) {
          if constexpr (B::nodes > 2) {
            const double work = take_projected<lanes>(domain, patch, block.displacements, basis);
            if (!counts) return;
            sums.stress.internal -= work;
            sums.kept_ahead += work;
          }
        });
  });
}

}  // namespace

template <int D>
void average_in_body(Domain<D>& domain) {
  project_pressure(domain, true);
}

template <int D>
void start_average_in_body(Domain<D>& domain) {
  project_pressure(domain, false);
}

template <int D>
void stop_average_in_body(Domain<D>& domain, int body) {
  domain.body_at(body).averages = false;
  for_each_patch(domain, in_body, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (patch.body != body) return;
    leave_stress(domain, patch);
    // Sums over the patches that hold a node are of all bodies.
    const NodeBlock<D> block = domain.grid.block(p);
    for (int n = 0; n < block.count; ++n) block.displacements[n][projected_at] = 0.0;
  });
}

template void average_in_body<2>(Domain<2>&);
template void average_in_body<3>(Domain<3>&);
template void start_average_in_body<2>(Domain<2>&);
template void start_average_in_body<3>(Domain<3>&);
template void stop_average_in_body<2>(Domain<2>&, int);
template void stop_average_in_body<3>(Domain<3>&, int);

}  // namespace mpm
