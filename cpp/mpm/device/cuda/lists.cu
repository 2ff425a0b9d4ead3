#include <algorithm>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include "mpm/device/cuda/lists.cuh"

namespace mpm {
namespace {

constexpr int threads = 256;
unsigned blocks_for(std::size_t n) { return static_cast<unsigned>((n + threads - 1) / threads); }

/// Place of a key among sorted ones; -1 if it is not there.
__device__ std::int32_t find(const std::uint64_t* keys, std::size_t count, std::uint64_t key) {
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

/// Where the tiles around each one are among keys; `mirrored` counts the offsets the other way.
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
__global__ void keep_patches(const std::uint64_t* keys, std::size_t patches,
                             const std::uint32_t* counts, int cells, std::uint64_t* to,
                             std::uint32_t* kept) {
  const std::size_t p = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (p >= patches) return;
  std::uint32_t sum = 0;
  for (int c = 0; c < cells; ++c) sum += counts[p * cells + c];
  if (sum > 0) to[atomicAdd(kept, 1u)] = keys[p];
}

__global__ void place_entries(const std::uint32_t* rows, std::size_t count,
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

}  // namespace

template <int D>
void DeviceLists<D>::find_node_tiles(const NodeBlockPlace<D>* blocks, std::size_t count,
                                     std::int32_t* to) const {
  launch(find_around_blocks<D>, blocks_for(count * around), threads, blocks, count,
         tile_keys_.data(), tiles_, to);
}

template <int D>
void DeviceLists<D>::find_patches(const NodeBlockPlace<D>* blocks, std::size_t count,
                                  std::int32_t* to) const {
  launch(find_around_blocks<D>, blocks_for(count * around), threads, blocks, count,
         patch_keys_.data(), patches_, to);
}

template <int D>
ListView<D> DeviceLists<D>::view() const {
  return {order_.data(),      cell_begin_.data(),   patch_body_.data(),
          patch_tile_.data(), patch_beside_.data(), nodes_beside_.data()};
}

template <int D>
NodeTileView<D> DeviceLists<D>::nodes(double* records) const {
  return {records, tile_body_.data(), tile_tile_.data(), holders_.data(), tile_beside_.data()};
}

template <int D>
MoveView DeviceLists<D>::begin_moves(void* room) {
  target_ = static_cast<std::uint32_t*>(room);
  slot_ = target_ + particles_;
  check_cuda(cudaMemsetAsync(counts_.data(), 0, patches_ * cells * sizeof(std::uint32_t)),
             "making lists");
  check_cuda(cudaMemsetAsync(counters_.data(), 0, 2 * sizeof(std::uint32_t)), "making lists");
  return {target_,
          slot_,
          counts_.data(),
          homeless_keys_.data(),
          counters_.data() + 1,
          static_cast<std::uint32_t>(homeless_keys_.size()),
          counters_.data()};
}

template <int D>
std::size_t DeviceLists<D>::sort_unique(DeviceArray<std::uint64_t>& keys, std::size_t count,
                                        DeviceArray<std::uint64_t>& unique) {
  sorted_keys_.need(count);
  std::size_t bytes = 0, more = 0;
  const int n = static_cast<int>(count);
  const auto sort = [&](void* scratch) {
    check_cuda(cub::DeviceRadixSort::SortKeys(scratch, bytes, keys.data(), sorted_keys_.data(), n),
               "sorting patches");
  };
  const auto drop = [&](void* scratch) {
    check_cuda(cub::DeviceSelect::Unique(scratch, more, sorted_keys_.data(), keys.data(),
                                         counters_.data() + 3, n),
               "sorting patches");
  };
  sort(nullptr);
  drop(nullptr);
  scratch_.need(std::max(bytes, more));
  sort(scratch_.data());
  drop(scratch_.data());
  std::uint32_t found = 0;
  counters_.give(&found, 1, 3);
  std::uint64_t last = 0;
  keys.give(&last, 1, found - 1);
  if (last == ~std::uint64_t{0})
    throw std::runtime_error("a particle has gone too far from where it began for a device, " +
                             std::to_string(Tile<D>::cells * TileKey<D>::half) + " cells");
  unique.need(found);
  check_cuda(cudaMemcpy(unique.data(), keys.data(), found * sizeof(std::uint64_t),
                        cudaMemcpyDeviceToDevice),
             "sorting patches");
  return found;
}

template <int D>
void DeviceLists<D>::make_tables(std::size_t given, std::size_t body_count) {
  bodies_ = body_count;
  patches_ = sort_unique(spare_keys_, given, patch_keys_);
  const std::size_t pairs = patches_ * around;
  spare_keys_.need(pairs);
  launch(list_node_tiles<D>, blocks_for(pairs), threads, patch_keys_.data(), patches_,
         reaches_before_, spare_keys_.data());
  tiles_ = sort_unique(spare_keys_, pairs, tile_keys_);
  patch_body_.need(patches_);
  patch_tile_.need(patches_);
  tile_body_.need(tiles_);
  tile_tile_.need(tiles_);
  launch(read_keys<D>, blocks_for(patches_), threads, patch_keys_.data(), patches_,
         patch_body_.data(), patch_tile_.data());
  launch(read_keys<D>, blocks_for(tiles_), threads, tile_keys_.data(), tiles_, tile_body_.data(),
         tile_tile_.data());
  const auto find_all = [&](DeviceArray<std::int32_t>& to, const auto& of, std::size_t count,
                            const auto& among, std::size_t among_count) {
    to.need(count * around);
    launch(find_around<D>, blocks_for(count * around), threads, of.data(), count, among.data(),
           among_count, to.data());
  };
  find_all(patch_beside_, patch_keys_, patches_, patch_keys_, patches_);
  find_all(nodes_beside_, patch_keys_, patches_, tile_keys_, tiles_);
  find_all(holders_, tile_keys_, tiles_, patch_keys_, patches_);
  find_all(tile_beside_, tile_keys_, tiles_, tile_keys_, tiles_);
  patch_of_body_.need(bodies_ + 1);
  tile_of_body_.need(bodies_ + 1);
  launch(find_bodies<D>, blocks_for(bodies_ + 1), threads, patch_keys_.data(), patches_, bodies_,
         patch_of_body_.data());
  launch(find_bodies<D>, blocks_for(bodies_ + 1), threads, tile_keys_.data(), tiles_, bodies_,
         tile_of_body_.data());
  counts_.need(patches_ * cells + 1);
  check_cuda(cudaGetLastError(), "making lists");
}

template <int D>
void DeviceLists<D>::place(const std::uint32_t* rows, const DeviceBody* bodies,
                           const ParticleView<D>* pools) {
  // One more than there are cells: the end of the last.
  const std::size_t count = patches_ * cells + 1;
  check_cuda(cudaMemsetAsync(counts_.data() + count - 1, 0, sizeof(std::uint32_t)), "making lists");
  cell_begin_.need(count);
  std::size_t bytes = 0;
  const int n = static_cast<int>(count);
  cub::DeviceScan::ExclusiveSum(nullptr, bytes, counts_.data(), cell_begin_.data(), n);
  scratch_.need(bytes);
  check_cuda(
      cub::DeviceScan::ExclusiveSum(scratch_.data(), bytes, counts_.data(), cell_begin_.data(), n),
      "making lists");
  launch(place_entries, blocks_for(particles_), threads, rows, particles_, target_, slot_,
         cell_begin_.data(), next_order_.data());
  launch(order_cells<D>, static_cast<unsigned>(patches_), 128, next_order_.data(),
         cell_begin_.data(), patch_body_.data(), bodies, pools, order_.data());
  check_cuda(cudaGetLastError(), "making lists");
}

template <int D>
void DeviceLists<D>::start(const GridGeometry<D>& grid, const DeviceBody* bodies,
                           const ParticleView<D>* pools, DeviceArray<std::uint64_t>& keys,
                           DeviceArray<std::uint32_t>& rows, std::size_t count,
                           std::size_t body_count, void* room) {
  particles_ = count;
  counters_.allocate(4);
  check_cuda(cudaMemset(counters_.data(), 0, 4 * sizeof(std::uint32_t)), "making lists");
  order_.allocate(count);
  next_order_.allocate(count);
  homeless_keys_.allocate(65536 + count / 64);
  spare_keys_.need(count);
  check_cuda(cudaMemcpy(spare_keys_.data(), keys.data(), count * sizeof(std::uint64_t),
                        cudaMemcpyDeviceToDevice),
             "making lists");
  make_tables(count, body_count);
  // As many keys as there are particles are wanted once.
  spare_keys_.release();
  sorted_keys_.release();
  scratch_.release();
  const MoveView moves = begin_moves(room);
  launch(find_first_targets<D>, blocks_for(count), threads, grid, grid.coordinates(),
         patch_keys_.data(), patches_, bodies, pools, keys.data(), rows.data(), count, moves);
  place(rows.data(), bodies, pools);
}

template <int D>
void DeviceLists<D>::finish_moves(const GridGeometry<D>& grid, const OutflowBox<D>& box,
                                  const DeviceBody* bodies, const ParticleView<D>* pools,
                                  bool changed, std::uint32_t homeless, bool gone) {
  // Entries are those of the patches before until they are placed.
  const std::size_t before = patches_;
  DeviceArray<std::int32_t> body_before;
  if (homeless > 0 || gone) {
    body_before.need(before);
    check_cuda(cudaMemcpy(body_before.data(), patch_body_.data(), before * sizeof(std::int32_t),
                          cudaMemcpyDeviceToDevice),
               "making lists");
  }
  // Once, unless more are homeless than there is room to note.
  for (bool drop = gone; homeless > 0 || drop; drop = false) {
    if (homeless > 0) add_patches(std::min<std::size_t>(homeless, homeless_keys_.size()));
    const MoveView moves = begin_moves(target_);
    launch(find_targets<D>, static_cast<unsigned>(before), 128, grid, box, grid.coordinates(),
           patch_keys_.data(), patches_, bodies, pools, order_.data(), cell_begin_.data(),
           body_before.data(), moves);
    check_cuda(cudaGetLastError(), "making lists");
    counters_.give(&homeless, 1, 1);
    changed = true;
  }
  if (changed) place(order_.data(), bodies, pools);
  if (!gone) return;
  std::uint32_t left = 0;
  cell_begin_.give(&left, 1, patches_ * cells);
  particles_ = left;
}

/// Patches for particles that have found none, and none any more for those that have none left.
template <int D>
void DeviceLists<D>::add_patches(std::size_t lost) {
  spare_keys_.need(patches_ + lost);
  check_cuda(cudaMemsetAsync(counters_.data() + 3, 0, sizeof(std::uint32_t)), "making lists");
  launch(keep_patches, blocks_for(patches_), threads, patch_keys_.data(), patches_, counts_.data(),
         static_cast<int>(cells), spare_keys_.data(), counters_.data() + 3);
  std::uint32_t kept = 0;
  counters_.give(&kept, 1, 3);
  check_cuda(cudaMemcpy(spare_keys_.data() + kept, homeless_keys_.data(),
                        lost * sizeof(std::uint64_t), cudaMemcpyDeviceToDevice),
             "making lists");
  make_tables(kept + lost, bodies_);
}

template class DeviceLists<2>;
template class DeviceLists<3>;

}  // namespace mpm
