#include <algorithm>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include "mpm/device/cuda/list_kernels.cuh"
#include "mpm/device/cuda/lists.cuh"

namespace mpm {
namespace {

constexpr int threads = 256;
unsigned blocks_for(std::size_t n) { return static_cast<unsigned>((n + threads - 1) / threads); }

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
                           std::size_t row_count, std::size_t body_count, void* room) {
  particles_ = count;
  counters_.allocate(4);
  check_cuda(cudaMemset(counters_.data(), 0, 4 * sizeof(std::uint32_t)), "making lists");
  order_.allocate(count);
  next_order_.allocate(row_count);
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
