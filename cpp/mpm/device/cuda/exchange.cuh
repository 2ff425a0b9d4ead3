#pragma once
// Nodes between the device and the host, which makes the stages of contact: halves of the records
// of the blocks that it has asked for, packed one behind another.
#include <vector>

#include "mpm/device/cuda/lists.cuh"

namespace mpm {

/// A block of threads a block of nodes.
template <int D, bool to_host>
__global__ void exchange_nodes(const NodeBlockPlace<D>* blocks, const std::int32_t* tiles,
                               double* records, HalfRecord* packed, int half) {
  const NodeBlockPlace<D> block = blocks[blockIdx.x];
  int count = 1;
  for (int a = 0; a < D; ++a) count *= block.nodes[a];
  for (int n = threadIdx.x; n < count; n += blockDim.x) {
    Index<D> offset, in_tile;
    for (int a = 0, left = n; a < D; left /= block.nodes[a++]) {
      const int from_tile = block.low[a] + left % block.nodes[a];
      offset[a] = tile_offset<D>(from_tile);
      in_tile[a] = from_tile - offset[a] * Tile<D>::cells;
    }
    const std::int32_t tile =
        tiles[std::size_t{blockIdx.x} * Tile<D>::neighbours + Tile<D>::neighbour(offset)];
    if (tile < 0) {
      // No particle reaches a node there.
      if constexpr (to_host) packed[block.first + n] = {0.0, 0.0, 0.0, 0.0};
      continue;
    }
    HalfRecord& record_half = reinterpret_cast<HalfRecord*>(
        records)[2 * (std::size_t(tile) * NodeTileView<D>::nodes + Tile<D>::cell(in_tile)) + half];
    // Several blocks have a node, and all the same of it.
    if constexpr (to_host)
      packed[block.first + n] = record_half;
    else
      record_half = packed[block.first + n];
  }
}

template <int D>
class NodeExchange {
 public:
  /// From now on, of these blocks.
  void choose(const std::vector<NodeBlockPlace<D>>& blocks, DeviceLists<D>& lists) {
    count_ = blocks.size();
    nodes_ = 0;
    if (count_ == 0) return;
    blocks_.take(blocks.data(), count_);
    for (const NodeBlockPlace<D>& block : blocks) {
      std::size_t n = 1;
      for (int a = 0; a < D; ++a) n *= static_cast<std::size_t>(block.nodes[a]);
      nodes_ += n;
    }
    tiles_.need(count_ * Tile<D>::neighbours);
    lists.find_node_tiles(blocks_.data(), count_, tiles_.data());
    for (int half = 0; half < 2; ++half)
      if (packed_[half].size() < nodes_) packed_[half].allocate(nodes_ + nodes_ / 8);
    on_device_.need(nodes_);
  }
  double* of_host(int half) { return reinterpret_cast<double*>(packed_[half].data()); }
  const double* read(double* records, int half) {
    if (nodes_ == 0) return nullptr;
    launch(exchange_nodes<D, true>, static_cast<unsigned>(count_), 128, blocks_.data(),
           tiles_.data(), records, on_device_.data(), half);
    check_cuda(cudaMemcpy(packed_[half].data(), on_device_.data(), nodes_ * sizeof(HalfRecord),
                          cudaMemcpyDeviceToHost),
               "giving nodes to the host");
    return of_host(half);
  }
  void write(double* records, int half) {
    if (nodes_ == 0) return;
    check_cuda(cudaMemcpyAsync(on_device_.data(), packed_[half].data(), nodes_ * sizeof(HalfRecord),
                               cudaMemcpyHostToDevice),
               "taking nodes of the host");
    launch(exchange_nodes<D, false>, static_cast<unsigned>(count_), 128, blocks_.data(),
           tiles_.data(), records, on_device_.data(), half);
  }

 private:
  std::size_t count_ = 0, nodes_ = 0;
  DeviceArray<NodeBlockPlace<D>> blocks_;
  DeviceArray<std::int32_t> tiles_;  // of each block, those around
  DeviceArray<HalfRecord> on_device_;
  PinnedArray<HalfRecord> packed_[2];
};

}  // namespace mpm
