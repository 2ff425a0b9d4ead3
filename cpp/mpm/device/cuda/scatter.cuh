#pragma once
// From particles to the nodes of their patch, in the order of the sums on the host: a few threads,
// one a node, take up to 16 particles of a cell one after another (a slot); then a thread for each
// node of the block adds up the slots that reach it, in the order of the cells. No atomics, so that
// every run has the same bits, and those of schedule/scatter.hpp.
#include "mpm/basis/basis.hpp"
#include "mpm/device/cuda/node_arithmetic.cuh"
#include "mpm/device/cuda/views.cuh"
#include "mpm/step/transfer/aflip.hpp"
#include "mpm/step/transfer/flip_pic.hpp"
#include "mpm/step/transfer/pic.hpp"

namespace mpm {

/// Threads of a block that scatters: at least one for each node of a patch's block.
inline constexpr int scatter_threads = 256;

template <class Transfer, unsigned what, class B, int D>
struct Scatter {
  static constexpr bool momentum = (what & gives_momentum) != 0,
                        forces = (what & gives_forces) != 0;
  static constexpr int halves = int{momentum} + int{forces};
  static constexpr int per_slot = 16;  // CellBuffer::room: sums have the same parts
  static constexpr int cells = Tile<D>::cell_count, nodes = power(B::nodes, D);
  static constexpr int lanes = B::nodes == 2 ? nodes : (D == 3 ? 32 : 16);
  static constexpr int at_once = scatter_threads / lanes;  // slots
  static constexpr int wanted = B::nodes == 2 ? 64 : (D == 3 ? 16 : 32) / halves;
  static constexpr int round = wanted < at_once ? at_once : wanted;  // slots whose sums are kept
  using Arithmetic =
      std::conditional_t<B::nodes == 2, TwoNodes<Transfer, what, D>, ThreeNodes<Transfer, what, D>>;

  /// Room for what particles of a slot have, where it is staged.
  static constexpr int staged_numbers = [] {
    if constexpr (Arithmetic::staged > 0)
      return Arithmetic::staged * Arithmetic::stride;
    else
      return 1;
  }();
  struct Shared {
    double staged[Arithmetic::staged > 0 ? at_once : 1][staged_numbers];
    HalfRecord sums[round][nodes][halves];
    std::uint32_t begin[cells + 1];       // of each cell's entries
    std::uint32_t first_slot[cells + 1];  // of each cell's slots
  };

  /// By all threads of a block.
  static __device__ void run(Shared& shared, const B& basis, const CellCoordinates<D>& coordinates,
                             const Index<D>& first_cell, const ListView<D>& lists,
                             const ParticleView<D>& particles, double minus_per_cell_size,
                             std::size_t patch, const PartialView& to) {
    find_slots(shared, lists.cell_begin + patch * cells);
    const std::uint32_t slots = shared.first_slot[cells];
    HalfRecord sum[halves];
    for (HalfRecord& s : sum) s = {0.0, 0.0, 0.0, 0.0};
    for (std::uint32_t from = 0; from < slots; from += round) {
      for (int s = threadIdx.x / lanes; s < round; s += at_once)
        if (from + s < slots)
          give(shared, s, from + s, basis, coordinates, first_cell, lists.order, particles,
               minus_per_cell_size);
      __syncthreads();
      add(shared, from, sum);
      __syncthreads();
    }
    constexpr int count = Block<B, D>::nodes;
    static_assert(count <= scatter_threads);
    if (threadIdx.x < count) {
      const std::size_t at = patch * count + threadIdx.x;
      if constexpr (momentum) to.first[at] = sum[0];
      if constexpr (forces) to.second[at] = sum[halves - 1];
    }
  }

 private:
  static __device__ void find_slots(Shared& shared, const std::uint32_t* cell_begin) {
    if (threadIdx.x <= cells) shared.begin[threadIdx.x] = cell_begin[threadIdx.x];
    __syncthreads();
    if (threadIdx.x < 32) {
      // Two cells a thread.
      const auto slots_of = [&](int c) {
        return (shared.begin[c + 1] - shared.begin[c] + per_slot - 1) / per_slot;
      };
      const int c = 2 * threadIdx.x;
      const std::uint32_t first = slots_of(c), both = first + slots_of(c + 1);
      std::uint32_t end = both;
      for (int by = 1; by < 32; by *= 2) {
        const std::uint32_t before = __shfl_up_sync(~0u, end, by);
        if (threadIdx.x >= by) end += before;
      }
      shared.first_slot[c] = end - both;
      shared.first_slot[c + 1] = end - both + first;
      if (threadIdx.x == 31) shared.first_slot[cells] = end;
    }
    __syncthreads();
  }

  /// The sums of one slot's particles, by a thread a node.
  static __device__ void give(Shared& shared, int place, std::uint32_t slot, const B& basis,
                              const CellCoordinates<D>& coordinates, const Index<D>& first_cell,
                              const std::uint32_t* order, const ParticleView<D>& particles,
                              double minus_per_cell_size) {
    const int k = threadIdx.x % lanes;
    // The last cell whose slots begin at this one or before; empty cells have none.
    int cell = 0;
    for (int step = cells / 2; step > 0; step /= 2)
      if (shared.first_slot[cell + step] <= slot) cell += step;
    const std::uint32_t begin = shared.begin[cell] + (slot - shared.first_slot[cell]) * per_slot;
    const std::uint32_t all = shared.begin[cell + 1],
                        end = all < begin + per_slot ? all : begin + per_slot;
    const Index<D> in_tile = Tile<D>::cell_index(cell);
    Index<D> at{};
    int left = k;
    for (int a = 0; a < D; ++a, left /= B::nodes) at[a] = left % B::nodes;
    const auto place_of = [&](std::uint32_t row) {
      Vec<double, D> xi;
      for (int a = 0; a < D; ++a)
        xi[a] = local_coordinate(coordinates.in_cells(particles.x[a][row], a),
                                 first_cell[a] + in_tile[a]);
      return xi;
    };
    Arithmetic arithmetic;
    if constexpr (Arithmetic::staged > 0) {
      double* const staged = shared.staged[threadIdx.x / lanes];
      const unsigned together = lanes == 32 ? ~0u : 0xffffu << (threadIdx.x & 16u);
      for (std::uint32_t from = begin; from < end; from += Arithmetic::at_once) {
        const int count = static_cast<int>(end - from) < Arithmetic::at_once
                              ? static_cast<int>(end - from)
                              : Arithmetic::at_once;
        if (k < count) {
          const std::uint32_t row = order[from + k];
          Arithmetic::stage(staged + k, basis, place_of(row), particles, row, minus_per_cell_size);
        }
        __syncwarp(together);
        for (int p = 0; p < count; ++p) arithmetic.add(staged + p, at);
        __syncwarp(together);
      }
      if (k >= nodes) return;
    } else {
      for (std::uint32_t g = begin; g < end; ++g) {
        const std::uint32_t row = order[g];
        arithmetic.template add<B>(basis, place_of(row), at, particles, row, minus_per_cell_size);
      }
    }
    if constexpr (momentum) shared.sums[place][k][0] = arithmetic.first();
    if constexpr (forces) shared.sums[place][k][halves - 1] = arithmetic.second();
  }

  /// Of the slots of this round, those that reach the thread's node.
  static __device__ void add(const Shared& shared, std::uint32_t from, HalfRecord* sum) {
    if (threadIdx.x >= Block<B, D>::nodes) return;
    const Index<D> node = Block<B, D>::index(threadIdx.x);
    Index<D> low, high;
    for (int a = 0; a < D; ++a) {
      low[a] = max(0, node[a] - B::nodes + 1);
      high[a] = min(Tile<D>::cells - 1, node[a]);
    }
    Index<D> cell = low;
    const auto add_cell = [&] {
      const int c = Tile<D>::cell(cell);
      int k = 0;
      for (int a = D - 1; a >= 0; --a) k = k * B::nodes + node[a] - cell[a];
      const std::uint32_t begin = max(shared.first_slot[c], from),
                          end = min(shared.first_slot[c + 1], from + round);
      for (std::uint32_t s = begin; s < end; ++s)
        for (int h = 0; h < halves; ++h) {
          const HalfRecord part = shared.sums[s - from][k][h];
          sum[h].x += part.x;
          sum[h].y += part.y;
          sum[h].z += part.z;
          sum[h].w += part.w;
        }
    };
    if constexpr (D == 3) {
      for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
        for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
          for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) add_cell();
    } else {
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
        for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) add_cell();
    }
  }
};

}  // namespace mpm
