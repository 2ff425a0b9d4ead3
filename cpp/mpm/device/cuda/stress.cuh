#pragma once
// Velocity gradients, eqs. (18)-(20), and the way through the material, a thread a particle; with
// the move, eq. (16), where the host fuses them.
#include "mpm/device/cuda/advance.cuh"
#include "mpm/materials/take_through.hpp"

namespace mpm {

/// What a step is for the particles of one material.
template <int D>
struct StressStep {
  ParticleStep<D> all;
  bool first;  // USF: strained by the velocities of the start, and nothing moves
  int pool;
  MaterialView material;
  BlockColumns<D> columns;
  StressSettings settings;
  double gradient_scale;             // time over which velocities strain / cell size
  double power_scale;                // time step / that time
  double* fastest;                   // of each patch
  std::uint32_t *negative, *eroded;  // flags
};

inline constexpr int stress_threads = 128;
// Blocks at once on a multiprocessor: with fewer a thread has more registers (cmake/device.cmake).
#if !defined(MPM_STRESS_BLOCKS)
#define MPM_STRESS_BLOCKS 4
#endif

/// The records of a patch's block, of any basis.
template <int D>
union AnyBlockNodes {
  BlockNodes<Linear, D> two;
  BlockNodes<QuadraticBSpline, D> three;
  __device__ AnyBlockNodes() {}
};

/// What a particle asks of its nodes: the gradient of the vector that strains, and the velocity
/// with which it moves.
template <int D>
struct Asked {
  std::array<Vec<double, D>, D> gradients;
  Vec<double, D> velocity;
};
template <class B, int D>
__device__ Asked<D> ask(const B& basis, BlockNodes<B, D>& nodes, const InCell<D>& at, bool first) {
  const NodeStrides<D> stride(Block<B, D>::edge,
                              D == 3 ? Block<B, D>::edge * Block<B, D>::edge : 0);
  const NodeRecords records = nodes.from(at.in_tile);
  const auto w = weights_at(basis, at.xi);
  // The number at which the vector stands that strains is no constant, so that one kernel serves
  // all schemes: MUSL's stands behind the velocity.
  static_assert(remapped_at == velocity_at + 3);
  const DeviceField<B, D> straining(records.at(first ? 0 : 3), stride);
  Asked<D> asked;
  asked.gradients = straining.template gradients<velocity_at>(w);
  if (!first) asked.velocity = DeviceField<B, D>(records, stride).template vector<velocity_at>(w);
  return asked;
}

/// One kernel for all bases and schemes: what it asks of the nodes is small beside the material, of
/// which each kernel costs the compiler seconds. With `step.first` (USF) nothing moves.
template <class Strength, class Eos, class Failures, int D>
__global__ void __launch_bounds__(stress_threads, MPM_STRESS_BLOCKS)
    stress_patches(const Strength strength, const Eos eos, const Failures failures,
                   ListView<D> lists, NodeTileView<D> nodes, StressStep<D> step) {
  __shared__ AnyBlockNodes<D> shared;
  __shared__ double scratch[stress_threads / 32];
  const std::size_t patch = blockIdx.x;
  const DeviceBody body = step.all.bodies[lists.body[patch]];
  if (body.pool != step.pool) return;
  const ParticleView<D>& of = step.all.pools[body.pool];
  const Index<D> first_cell = step.all.grid.first_cell(lists.tile[patch]);
  const std::int32_t* const beside = lists.nodes_beside + patch * Tile<D>::neighbours;
  const bool linear = step.all.grid.basis == basis_id<Linear>;
  if (linear)
    shared.two.load(nodes, beside, true, !step.first);
  else
    shared.three.load(nodes, beside, true, !step.first);
  // What the kernel was made for is known to its compiler.
  MaterialView material = step.material;
  material.has_eos = !std::is_same_v<Eos, NoEos>;
  material.judged = !std::is_same_v<Failures, NoFailures>;
  StressSums sums;
  bool changed = false;
  double carried = 0.0;
  const std::uint32_t begin = lists.cell_begin[patch * Tile<D>::cell_count],
                      end = lists.cell_begin[(patch + 1) * Tile<D>::cell_count];
  for (std::uint32_t g = begin + threadIdx.x; g < end; g += stress_threads) {
    MaterialBlock<D, 1> block;
    block.count = 1;
    const std::uint32_t row = lists.order[g];
    block.row[0] = row;
    const InCell<D> at(step.all.coordinates, first_cell, of, row);
    Asked<D> asked;
    if (linear)
      asked = ask(Linear(body.edge), shared.two, at, step.first);
    else if (step.all.grid.basis == basis_id<Gimp>)
      asked = ask(Gimp(body.edge), reinterpret_cast<BlockNodes<Gimp, D>&>(shared.three), at,
                  step.first);
    else
      asked = ask(QuadraticBSpline(body.edge), shared.three, at, step.first);
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        block.gradient[i][j][0] = step.gradient_scale * asked.gradients[i][j];
    if (!step.first && of.affine[0] != nullptr)
      carried += carry_affine(of, row, step.all.time_step);
    if (!step.first)
      changed |= move_particle(step.all.grid, step.all.coordinates, lists, of, patch, g, row, at,
                               asked.velocity, step.all.time_step, step.all.moves);
    take_through<double>(material, strength, eos, failures, step.columns, step.settings, block,
                         sums);
  }
  const auto write = [&](int place, double x) {
    x = block_sum<stress_threads>(x, scratch);
    if (threadIdx.x == 0)
      step.all.sums[(place - DeviceSum::of_nodes) * step.all.patches + patch] = x;
  };
  write(DeviceSum::internal, sums.internal);
  write(DeviceSum::plastic, sums.plastic);
  if (step.material.viscosity.active()) write(DeviceSum::viscous, sums.viscous);
  if (step.material.damping.active()) write(DeviceSum::damped, sums.damped);
  if (step.material.bounds.active) {
    write(DeviceSum::bounded, sums.bounded);
    write(DeviceSum::energy_floor, sums.energy_floor);
  }
  if constexpr (!std::is_same_v<Failures, NoFailures>) write(DeviceSum::fracture, sums.fracture);
  write(DeviceSum::force_power, step.power_scale * sums.force_power);
  if (!step.first) write_carried<stress_threads>(step.all, patch, carried, scratch);
  const double fastest = block_max<stress_threads>(sums.fastest, scratch);
  if (threadIdx.x == 0) step.fastest[patch] = fastest;
  if (__syncthreads_or(sums.negative_volume) && threadIdx.x == 0) *step.negative = 1;
  if constexpr (!std::is_same_v<Failures, NoFailures>)
    if (__syncthreads_or(sums.eroded) && threadIdx.x == 0) *step.eroded = 1;
  if (__syncthreads_or(changed) && threadIdx.x == 0) *step.all.moves.changed = 1;
}

/// An equation of state linear in the energy, whichever it is.
struct AnyLinearEos {
  using Models = EosModels::Any;
  int index = 0;
  alignas(8) std::byte bytes[sizeof(EosModels::Any)];

  template <class T>
  __device__ LinearInEnergy<T> at(T V) const {
    LinearInEnergy<T> line{};
    with([&](const auto& model) {
      if constexpr (LinearEos<std::remove_cvref_t<decltype(model)>>) line = model.at(V);
    });
    return line;
  }

 private:
  template <class F>
  __device__ void with(F&& f) const {
    with_of(f, static_cast<Models*>(nullptr));
  }
  template <class F, class... M>
  __device__ void with_of(F&& f, std::variant<M...>*) const {
    int k = 0;
    ((index == k++ ? static_cast<void>(f(*reinterpret_cast<const M*>(bytes))) : void()), ...);
  }
};

}  // namespace mpm
