#pragma once
// The kernels that make lists of particles by cell, patches and tiles of nodes.
#include "mpm/device/cuda/gather.cuh"
#include "mpm/device/device_run.hpp"

namespace mpm {

/// Place of a key among sorted ones; -1 if it is not there.
static __device__ std::int32_t find(const std::uint64_t* keys, std::size_t count,
                                    std::uint64_t key) {
  std::size_t low = 0, high = count;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (keys[middle] < key)
      low = middle + 1;
    else
      high = middle;
  }
  return low < count && keys[low] == key ? static_cast<std::int32_t>(low) : -1;
}

/// The bodies and tiles that keys name.
template <int D>
__global__ void read_keys(const std::uint64_t* keys, std::size_t count, std::int32_t* body,
                          Index<D>* tile) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k >= count) return;
  body[k] = TileKey<D>::body(keys[k]);
  tile[k] = TileKey<D>::tile(keys[k]);
}

/// Where the tiles around each one are among keys.
template <int D>
__global__ void find_around(const std::uint64_t* tiles, std::size_t count,
                            const std::uint64_t* keys, std::size_t key_count, std::int32_t* to) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k >= count * Tile<D>::neighbours) return;
  const std::uint64_t key = tiles[k / Tile<D>::neighbours];
  const Index<D> tile =
      Tile<D>::beside(TileKey<D>::tile(key), static_cast<int>(k % Tile<D>::neighbours));
  to[k] = find(keys, key_count, TileKey<D>::of(TileKey<D>::body(key), tile));
}

/// The same around blocks of nodes.
template <int D>
__global__ void find_around_blocks(const NodeBlockPlace<D>* blocks, std::size_t count,
                                   const std::uint64_t* keys, std::size_t key_count,
                                   std::int32_t* to) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k >= count * Tile<D>::neighbours) return;
  const NodeBlockPlace<D>& block = blocks[k / Tile<D>::neighbours];
  const Index<D> tile = Tile<D>::beside(block.tile, static_cast<int>(k % Tile<D>::neighbours));
  to[k] = find(keys, key_count, TileKey<D>::of(block.body, tile));
}

/// The keys of the tiles in which patches have nodes: those around each, or only those behind.
template <int D>
__global__ void list_node_tiles(const std::uint64_t* patches, std::size_t count, bool before,
                                std::uint64_t* to) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k >= count * Tile<D>::neighbours) return;
  const std::uint64_t key = patches[k / Tile<D>::neighbours];
  const Index<D> offset = Tile<D>::offset(static_cast<int>(k % Tile<D>::neighbours));
  Index<D> tile = TileKey<D>::tile(key);
  for (int a = 0; a < D; ++a) tile[a] += before ? offset[a] : max(offset[a], 0);
  to[k] = TileKey<D>::of(TileKey<D>::body(key), tile);
}

/// First place of each body, and the end.
template <int D>
__global__ void find_bodies(const std::uint64_t* keys, std::size_t count, std::size_t bodies,
                            std::uint32_t* first) {
  const std::size_t b = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (b > bodies) return;
  std::size_t low = 0, high = count;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (static_cast<std::size_t>(TileKey<D>::body(keys[middle])) < b)
      low = middle + 1;
    else
      high = middle;
  }
  first[b] = static_cast<std::uint32_t>(low);
}

/// The tile and cell of a place, and with them the target of an entry among the patches.
template <int D>
__device__ void find_target_by_key(const GridGeometry<D>& grid,
                                   const CellCoordinates<D>& coordinates, const std::uint64_t* keys,
                                   std::size_t patches, int body, const Vec<double, D>& x,
                                   std::size_t entry, const MoveView& moves) {
  Index<D> cell;
  for (int a = 0; a < D; ++a) cell[a] = static_cast<int>(::floor(coordinates.in_cells(x[a], a)));
  const Index<D> tile = grid.tile_of(cell), first = grid.first_cell(tile);
  for (int a = 0; a < D; ++a) cell[a] -= first[a];
  const std::uint64_t key =
      TileKey<D>::holds(tile) ? TileKey<D>::of(body, tile) : ~std::uint64_t{0};
  const std::int32_t patch = find(keys, patches, key);
  if (patch < 0) {
    moves.target[entry] = MoveView::homeless;
    const std::uint32_t k = atomicAdd(moves.homeless_count, 1u);
    if (k < moves.homeless_room) moves.homeless_keys[k] = key;
    return;
  }
  const std::uint32_t target = static_cast<std::uint32_t>(patch) * Tile<D>::cell_count +
                               static_cast<std::uint32_t>(Tile<D>::cell(cell));
  moves.target[entry] = target;
  moves.slot[entry] = atomicAdd(moves.counts + target, 1u);
}

/// Of entries in lists that there were.
template <int D>
__global__ void find_targets(GridGeometry<D> grid, OutflowBox<D> box,
                             CellCoordinates<D> coordinates, const std::uint64_t* keys,
                             std::size_t patches, const DeviceBody* bodies,
                             const ParticleView<D>* pools, const std::uint32_t* order,
                             const std::uint32_t* cell_begin, const std::int32_t* patch_body,
                             MoveView moves) {
  const int body = patch_body[blockIdx.x];
  const ParticleView<D>& of = pools[bodies[body].pool];
  const std::size_t cells = Tile<D>::cell_count;
  for (std::uint32_t g = cell_begin[blockIdx.x * cells] + threadIdx.x;
       g < cell_begin[(blockIdx.x + 1) * cells]; g += blockDim.x) {
    const Vec<double, D> x = place_of_row(of, order[g]);
    const bool eroded =
        of.failed != nullptr && of.failed[order[g]] >= static_cast<double>(FailureAction::erode);
    if (eroded || (box.exist && !box.holds(x)))
      moves.target[g] = MoveView::homeless;  // it takes no part any more
    else
      find_target_by_key(grid, coordinates, keys, patches, body, x, g, moves);
  }
}

/// Of particles that are in no list yet, by the keys of their patches.
template <int D>
__global__ void find_first_targets(GridGeometry<D> grid, CellCoordinates<D> coordinates,
                                   const std::uint64_t* keys, std::size_t patches,
                                   const DeviceBody* bodies, const ParticleView<D>* pools,
                                   const std::uint64_t* of_entries, const std::uint32_t* rows,
                                   std::size_t count, MoveView moves) {
  const std::size_t g = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (g >= count) return;
  const int body = TileKey<D>::body(of_entries[g]);
  find_target_by_key(grid, coordinates, keys, patches, body,
                     place_of_row(pools[bodies[body].pool], rows[g]), g, moves);
}

/// The keys of patches that still hold particles.
static __global__ void keep_patches(const std::uint64_t* keys, std::size_t patches,
                                    const std::uint32_t* counts, int cells, std::uint64_t* to,
                                    std::uint32_t* kept) {
  const std::size_t p = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (p >= patches) return;
  std::uint32_t sum = 0;
  for (int c = 0; c < cells; ++c) sum += counts[p * cells + c];
  if (sum > 0) to[atomicAdd(kept, 1u)] = keys[p];
}

static __global__ void place_entries(const std::uint32_t* rows, std::size_t count,
                                     const std::uint32_t* target, const std::uint32_t* slot,
                                     const std::uint32_t* cell_begin, std::uint32_t* to) {
  const std::size_t g = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (g < count && target[g] != MoveView::homeless) to[cell_begin[target[g]] + slot[g]] = rows[g];
}

/// The particles of each cell in the order of their numbers: a thread counts those before its own.
template <int D>
__global__ void order_cells(const std::uint32_t* rows, const std::uint32_t* cell_begin,
                            const std::int32_t* patch_body, const DeviceBody* bodies,
                            const ParticleView<D>* pools, std::uint32_t* to) {
  constexpr int cells = Tile<D>::cell_count;
  __shared__ std::uint32_t begin[cells + 1];
  for (int c = threadIdx.x; c <= cells; c += blockDim.x)
    begin[c] = cell_begin[std::size_t{blockIdx.x} * cells + c];
  __syncthreads();
  const std::uint32_t* const id = pools[bodies[patch_body[blockIdx.x]].pool].id;
  for (std::uint32_t e = begin[0] + threadIdx.x; e < begin[cells]; e += blockDim.x) {
    int cell = 0;
    for (int step = cells / 2; step > 0; step /= 2)
      if (begin[cell + step] <= e) cell += step;
    const std::uint32_t row = rows[e], own = id[row];
    std::uint32_t rank = begin[cell];
    for (std::uint32_t k = begin[cell]; k < begin[cell + 1]; ++k) rank += id[rows[k]] < own;
    to[rank] = row;
  }
}

}  // namespace mpm
