#pragma once
// Small kernels of a run's bookkeeping: sums of bodies, rows in another order, particles to look
// at.
#include "mpm/device/cuda/gather.cuh"
#include "mpm/device/device_run.hpp"

namespace mpm {

inline unsigned blocks_of(std::size_t n) { return static_cast<unsigned>((n + 255) / 256); }

/// The sums of each body, a block of threads for each body and place: in one order.
static __global__ void sum_bodies(const double* of, std::size_t count, const std::uint32_t* first,
                                  double* to, int to_place) {
  __shared__ double scratch[8];
  const std::size_t body = blockIdx.x, place = blockIdx.y;
  double sum = 0.0;
  for (std::uint32_t k = first[body] + threadIdx.x; k < first[body + 1]; k += 256)
    sum += of[place * count + k];
  sum = block_sum<256>(sum, scratch);
  if (threadIdx.x == 0) to[body * DeviceSum::count + to_place + place] = sum;
}
static __global__ void find_fastest(const double* of, const std::uint32_t* first, double* to) {
  __shared__ double scratch[8];
  double most = 0.0;
  for (std::uint32_t k = first[blockIdx.x] + threadIdx.x; k < first[blockIdx.x + 1]; k += 256)
    most = max(most, of[k]);
  most = block_max<256>(most, scratch);
  if (threadIdx.x == 0) to[blockIdx.x] = most;
}

/// Keys of the patches of particles that are in no list yet.
template <int D>
__global__ void first_keys(GridGeometry<D> grid, ParticleView<D> of, const std::uint32_t* body,
                           std::size_t rows, std::uint64_t* keys, std::uint32_t* of_entry,
                           std::uint32_t* count) {
  const std::size_t row = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (row >= rows || body[row] == DevicePool::no_body) return;
  const CellCoordinates<D> coordinates = grid.coordinates();
  Index<D> cell;
  for (int a = 0; a < D; ++a)
    cell[a] = static_cast<int>(::floor(coordinates.in_cells(of.x[a][row], a)));
  const Index<D> tile = grid.tile_of(cell);
  const std::uint32_t e = atomicAdd(count, 1u);
  keys[e] = TileKey<D>::holds(tile) ? TileKey<D>::of(static_cast<int>(body[row]), tile)
                                    : ~std::uint64_t{0};
  of_entry[e] = static_cast<std::uint32_t>(row);
}

/// Rows in the order of the lists: entry k of the pool goes to row k.
template <class Number>
__global__ void take_rows(const Number* from, const std::uint32_t* rows, std::size_t count,
                          Number* to) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k < count) to[k] = from[rows[k]];
}
template <class Number>
__global__ void give_rows(const Number* from, const std::uint32_t* rows, std::size_t count,
                          Number* to) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k < count) to[rows[k]] = from[k];
}
static __global__ void count_up(std::uint32_t* to, std::size_t count) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k < count) to[k] = static_cast<std::uint32_t>(k);
}
/// The first entry of each body's lists, and the end.
static __global__ void first_entries(const std::uint32_t* cell_begin,
                                     const std::uint32_t* patch_of_body, int cells,
                                     std::size_t count, std::uint32_t* to) {
  const std::size_t b = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (b < count) to[b] = cell_begin[std::size_t{patch_of_body[b]} * cells];
}
/// Entries whose row is not the one after that of the entry before.
static __global__ void count_jumps(const std::uint32_t* order, std::size_t count,
                                   std::uint32_t* jumps) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  const bool jump = k > 0 && k < count && order[k] != order[k - 1] + 1;
  const int all = __syncthreads_count(jump);
  if (threadIdx.x == 0 && all > 0) atomicAdd(jumps, static_cast<std::uint32_t>(all));
}
/// Is any particle out of the region that is kept? A block of threads a patch.
template <int D>
__global__ void find_left(OutflowBox<D> box, ListView<D> lists, const DeviceBody* bodies,
                          const ParticleView<D>* pools, std::uint32_t* gone) {
  const ParticleView<D>& of = pools[bodies[lists.body[blockIdx.x]].pool];
  const std::uint32_t end = lists.cell_begin[(blockIdx.x + 1) * Tile<D>::cell_count];
  bool left = false;
  for (std::uint32_t g = lists.cell_begin[blockIdx.x * Tile<D>::cell_count] + threadIdx.x; g < end;
       g += blockDim.x)
    left = left || !box.holds(place_of_row(of, lists.order[g]));
  if (__syncthreads_or(left) && threadIdx.x == 0) *gone = 1;
}

/// Particles that somebody should look at: far too large or small, or beyond the box
/// (run/watch.cpp). A block of threads a patch.
template <int D>
__global__ void count_odd(GridGeometry<D> grid, ListView<D> lists, const DeviceBody* bodies,
                          const ParticleView<D>* pools, const double* densities,
                          std::uint32_t* odd) {
  constexpr double beyond = 0.1;  // of a cell
  const int pool = bodies[lists.body[blockIdx.x]].pool;
  const ParticleView<D>& of = pools[pool];
  const std::uint32_t end = lists.cell_begin[(blockIdx.x + 1) * Tile<D>::cell_count];
  bool found = false;
  for (std::uint32_t g = lists.cell_begin[blockIdx.x * Tile<D>::cell_count] + threadIdx.x; g < end;
       g += blockDim.x) {
    const std::uint32_t row = lists.order[g];
    const double J = of.volume[row] * densities[pool] / of.mass[row];
    const bool failed = of.failed != nullptr && of.failed[row] > 0.0;
    found = found || !(failed || (J > 0.01 && J < 100.0));
    for (int a = 0; grid.walls.exist && a < D; ++a) {
      const double x = (of.x[a][row] - grid.origin[a]) / grid.cell_size;
      found = found || !(x > -beyond && x < grid.walls.cells[a] + beyond);
    }
  }
  const int all = __syncthreads_count(found);
  if (threadIdx.x == 0 && all > 0) atomicAdd(odd, static_cast<std::uint32_t>(all));
}

}  // namespace mpm
