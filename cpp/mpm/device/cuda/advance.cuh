#pragma once
// Eq. (17), a block of threads a patch: particles take what the nodes have; with it MUSL's remap,
// or the move (USF), as the host fuses them.
#include "mpm/device/cuda/gather.cuh"
#include "mpm/device/cuda/scatter.cuh"
#include "mpm/step/transfer/aflip.hpp"
#include "mpm/step/transfer/flip_pic.hpp"
#include "mpm/step/transfer/pic.hpp"

namespace mpm {

/// What a step is for particles.
template <int D>
struct ParticleStep {
  GridGeometry<D> grid;
  CellCoordinates<D> coordinates;
  const DeviceBody* bodies;
  const ParticleView<D>* pools;
  double time_step, minus_per_cell_size;
  double affine_moment, to_affine;  // D of APIC [m^2]; h / D
  MoveView moves;
  double* sums;  // [DeviceSum - of_nodes][patch]
  std::size_t patches;
};

/// What the affine parts of a patch's particles have lost as they were carried along: the sum of
/// what carry_affine() has returned to the threads.
template <int threads, int D>
__device__ void write_carried(const ParticleStep<D>& step, std::size_t patch, double carried,
                              double* scratch) {
  carried = block_sum<threads>(carried, scratch);
  if (threadIdx.x == 0)
    step.sums[(DeviceSum::carried - DeviceSum::of_nodes) * step.patches + patch] =
        0.5 * step.affine_moment * carried;
}

/// What is done beside eq. (17) while the particles are at hand.
enum class DeviceAlso { nothing, remap, move };

/// The transfer of a step, with the share of a material.
template <class Transfer>
__device__ Transfer transfer_with(double share) {
  if constexpr (std::is_constructible_v<Transfer, double>)
    return Transfer(share);
  else
    return Transfer();
}

/// A remap is a scatter; without one fewer threads with more registers are faster.
inline constexpr int move_threads = 128;
template <DeviceAlso also>
inline constexpr int advance_threads = also == DeviceAlso::remap ? scatter_threads : move_threads;

template <class Transfer, DeviceAlso also, class B, int D>
__global__ void __launch_bounds__(advance_threads<also>, also != DeviceAlso::remap ? 4
                                                         : B::nodes == 2           ? 3
                                                                                   : 2)
    advance_patches(ListView<D> lists, NodeTileView<D> nodes, PartialView partial,
                    ParticleStep<D> step) {
  using Remap = Scatter<typename Transfer::Gives, gives_momentum, B, D>;
  struct Nothing {};
  union Shared {
    BlockNodes<B, D> nodes;
    std::conditional_t<also == DeviceAlso::remap, typename Remap::Shared, Nothing> remap;
    __device__ Shared() {}
  };
  constexpr int threads = advance_threads<also>;
  __shared__ Shared shared;
  __shared__ double scratch[threads / 32];
  const std::size_t patch = blockIdx.x;
  const DeviceBody body = step.bodies[lists.body[patch]];
  const ParticleView<D>& of = step.pools[body.pool];
  const B basis(body.edge);
  const Index<D> first_cell = step.grid.first_cell(lists.tile[patch]);
  const Transfer transfer = transfer_with<Transfer>(of.share);
  constexpr bool reads_velocity = Transfer::takes_grid_velocity || also == DeviceAlso::move;
  shared.nodes.load(nodes, lists.nodes_beside + patch * Tile<D>::neighbours, reads_velocity, true);

  double kinetic = 0.0, second_order = 0.0, transferred = 0.0, carried = 0.0;
  Vec<double, D> momentum = Vec<double, D>::zero();
  bool changed = false;
  const NodeStrides<D> stride(Block<B, D>::edge,
                              D == 3 ? Block<B, D>::edge * Block<B, D>::edge : 0);
  const std::uint32_t begin = lists.cell_begin[patch * Tile<D>::cell_count],
                      end = lists.cell_begin[(patch + 1) * Tile<D>::cell_count];
  for (std::uint32_t g = begin + threadIdx.x; g < end; g += threads) {
    const std::uint32_t row = lists.order[g];
    const InCell<D> at(step.coordinates, first_cell, of, row);
    const DeviceField<B, D> field(shared.nodes.from(at.in_tile), stride);
    const auto w = weights_at(basis, at.xi);
    // All that is read comes before what is written, else each number would wait for the last: the
    // compiler cannot know that columns are apart.
    const double m = of.mass[row];
    double v_before[D], C_before[Transfer::affine ? D * D : 1];
    for (int a = 0; a < D; ++a) v_before[a] = of.v[a][row];
    if constexpr (Transfer::affine)
      for (int k = 0; k < D * D; ++k) C_before[k] = of.affine[k][row];
    const Vec<double, D> dv = field.template vector<increment_at>(w);
    Vec<double, D> beside = Vec<double, D>::zero();
    if constexpr (Transfer::affine) {
      const auto moments = moments_at<B>(at.xi, w);
      Mat<double, D> C;
      field.template value_and_moments<velocity_at>(w, moments, beside, C);
      double before = 0.0, after = 0.0;
      for (int k = 0; k < D * D; ++k) {
        const double now = C[k / D][k % D] * step.to_affine, old = C_before[k];
        before = fma(old, old, before);
        after = fma(now, now, after);
        of.affine[k][row] = now;
      }
      const double scale = step.affine_moment * m;
      kinetic = fma(scale, after, kinetic);
      transferred = fma(scale, before - after, transferred);
    } else if constexpr (Transfer::takes_grid_velocity) {
      beside = field.template vector<velocity_at>(w);
    }
    Transfer here = transfer;
    if constexpr (requires { transfer.at_fixed_walls(); })
      if (step.grid.walls.fixes_near(at.cell, B::before, B::nodes - 1 - B::before))
        here = transfer.at_fixed_walls();
    double speed2 = 0.0, change2 = 0.0;
    for (int a = 0; a < D; ++a) {
      const double before = v_before[a];
      double taken;
      if constexpr (Transfer::takes_grid_velocity) {
        taken = here.take(before, dv[a], beside[a]);
        const double kept = Transfer::affine ? before : before + dv[a];
        transferred += m * kept * kept - m * taken * taken;
      } else {
        taken = here.take(before, dv[a]);
      }
      of.v[a][row] = taken;
      momentum[a] = fma(m, taken, momentum[a]);
      speed2 = fma(taken, taken, speed2);
      change2 = fma(dv[a], dv[a], change2);
    }
    kinetic = fma(m, speed2, kinetic);
    second_order = fma(m, change2, second_order);
    if constexpr (also == DeviceAlso::move && Transfer::affine)
      carried += carry_affine(of, row, step.time_step);
    if constexpr (also == DeviceAlso::move)
      changed |= move_particle(
          step.grid, step.coordinates, lists, of, patch, g, row, at,
          Transfer::takes_grid_velocity ? beside : field.template vector<velocity_at>(w),
          step.time_step, step.moves);
  }
  const auto write = [&](int place, double x) {
    x = block_sum<threads>(x, scratch);
    if (threadIdx.x == 0) step.sums[(place - DeviceSum::of_nodes) * step.patches + patch] = x;
  };
  write(DeviceSum::kinetic, 0.5 * kinetic);
  write(DeviceSum::second_order, 0.5 * second_order);
  if constexpr (Transfer::takes_grid_velocity) write(DeviceSum::transferred, 0.5 * transferred);
  if constexpr (also == DeviceAlso::move && Transfer::affine)
    write_carried<threads>(step, patch, carried, scratch);
  for (int a = 0; a < D; ++a) write(DeviceSum::momentum + a, momentum[a]);
  // All have read the nodes, and all have written their velocities.
  if (__syncthreads_or(changed) && threadIdx.x == 0) *step.moves.changed = 1;
  if constexpr (also == DeviceAlso::remap)
    Remap::run(shared.remap, basis, step.coordinates, first_cell, lists, of,
               step.minus_per_cell_size, patch, partial);
}

/// Eq. (16) by itself, where particles move with another velocity than they are advanced with.
template <class B, int D>
__global__ void __launch_bounds__(move_threads)
    move_patches(ListView<D> lists, NodeTileView<D> nodes, ParticleStep<D> step) {
  __shared__ BlockNodes<B, D> shared;
  const std::size_t patch = blockIdx.x;
  const DeviceBody body = step.bodies[lists.body[patch]];
  const ParticleView<D>& of = step.pools[body.pool];
  const Index<D> first_cell = step.grid.first_cell(lists.tile[patch]);
  shared.load(nodes, lists.nodes_beside + patch * Tile<D>::neighbours, true, false);
  const NodeStrides<D> stride(Block<B, D>::edge,
                              D == 3 ? Block<B, D>::edge * Block<B, D>::edge : 0);
  const B basis(body.edge);
  __shared__ double scratch[move_threads / 32];
  double carried = 0.0;
  bool changed = false;
  const std::uint32_t end = lists.cell_begin[(patch + 1) * Tile<D>::cell_count];
  for (std::uint32_t g = lists.cell_begin[patch * Tile<D>::cell_count] + threadIdx.x; g < end;
       g += move_threads) {
    const std::uint32_t row = lists.order[g];
    const InCell<D> at(step.coordinates, first_cell, of, row);
    const DeviceField<B, D> field(shared.from(at.in_tile), stride);
    const Vec<double, D> v = field.template vector<velocity_at>(weights_at(basis, at.xi));
    if (of.affine[0] != nullptr) carried += carry_affine(of, row, step.time_step);
    changed |= move_particle(step.grid, step.coordinates, lists, of, patch, g, row, at, v,
                             step.time_step, step.moves);
  }
  write_carried<move_threads>(step, patch, carried, scratch);
  if (__syncthreads_or(changed) && threadIdx.x == 0) *step.moves.changed = 1;
}

/// Eqs. (2), (3), (9): what a patch's particles give to its nodes.
template <class Gives, unsigned what, class B, int D>
__global__ void __launch_bounds__(scatter_threads, B::nodes == 2 ? 3 : 4)
    map_patches(ListView<D> lists, PartialView partial, ParticleStep<D> step) {
  using Map = Scatter<Gives, what, B, D>;
  __shared__ typename Map::Shared shared;
  const std::size_t patch = blockIdx.x;
  const DeviceBody body = step.bodies[lists.body[patch]];
  Map::run(shared, B(body.edge), step.coordinates, step.grid.first_cell(lists.tile[patch]), lists,
           step.pools[body.pool], step.minus_per_cell_size, patch, partial);
}

}  // namespace mpm
