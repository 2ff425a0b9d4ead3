#pragma once
// Nodes between the device and the host, which makes some stages: halves of the records of the
// blocks that it has asked for, packed one behind another.
#include <vector>

#include "mpm/device/cuda/lists.cuh"
#include "mpm/device/cuda/node_sums.cuh"
#include "mpm/device/device_run.hpp"

namespace mpm {

/// The places of the halves of a block's nodes among the sums of the nodes.
template <int D>
struct SummedNodes {
  const std::int32_t* tiles;  // of each block, those around
  HalfRecord* records;
  int half;

  __device__ HalfRecord* at(std::size_t block, const AnIndex<D>& from_tile) const {
    Index<D> offset, in_tile;
    for (int a = 0; a < D; ++a) {
      offset[a] = tile_offset<D>(from_tile[a]);
      in_tile[a] = from_tile[a] - offset[a] * Tile<D>::cells;
    }
    const std::int32_t tile = tiles[block * Tile<D>::neighbours + Tile<D>::neighbour(offset)];
    if (tile < 0) return nullptr;  // no particle reaches it
    return records + 2 * (std::size_t(tile) * NodeTileView<D>::nodes + Tile<D>::cell(in_tile)) +
           half;
  }
};

/// The same among what the particles of each patch have given.
template <int D>
struct MappedNodes {
  const std::int32_t* tiles;  // of each block: the patch itself is in the middle
  HalfRecord* partial;
  int edge, low;  // of a patch's block along each axis

  __device__ HalfRecord* at(std::size_t block, const AnIndex<D>& from_tile) const {
    const std::int32_t patch = tiles[block * Tile<D>::neighbours + Tile<D>::self];
    if (patch < 0) return nullptr;
    std::size_t n = 0, count = 1;
    for (int a = D - 1; a >= 0; --a) {
      n = n * edge + (from_tile[a] - low);
      count *= edge;
    }
    return partial + patch * count + n;
  }
};

/// A block of threads a block of nodes.
template <int D, bool to_host, class Places>
__global__ void exchange_nodes(const NodeBlockPlace<D>* blocks, Places places, HalfRecord* packed) {
  const NodeBlockPlace<D> block = blocks[blockIdx.x];
  int count = 1;
  for (int a = 0; a < D; ++a) count *= block.nodes[a];
  for (int n = threadIdx.x; n < count; n += blockDim.x) {
    Index<D> from_tile;
    for (int a = 0, left = n; a < D; left /= block.nodes[a++])
      from_tile[a] = block.low[a] + left % block.nodes[a];
    HalfRecord* const there = places.at(blockIdx.x, from_tile);
    // Several blocks have a node, and all the same of its sum.
    if constexpr (to_host)
      packed[block.first + n] = there != nullptr ? *there : HalfRecord{0.0, 0.0, 0.0, 0.0};
    else if (there != nullptr)
      *there = packed[block.first + n];
  }
}

/// Weigh the forces of some patches' blocks, a block of threads each, before the host adds to them.
template <class B, int D>
__global__ void weigh_mapped(ListView<D> lists, const std::int32_t* around, PartialView partial,
                             GridGeometry<D> grid, Vec<double, D> gravity) {
  const std::int32_t patch = around[blockIdx.x * Tile<D>::neighbours + Tile<D>::self];
  if (patch < 0) return;
  const std::size_t block = std::size_t(patch) * Block<B, D>::nodes;
  const Index<D> first = grid.first_cell(lists.tile[patch]);
  for (int n = threadIdx.x; n < Block<B, D>::nodes; n += blockDim.x) {
    const Index<D> in_block = Block<B, D>::index(n);
    Index<D> node;
    for (int a = 0; a < D; ++a) node[a] = first[a] + Block<B, D>::low + in_block[a];
    if (Image<D>(grid, true, node).exists) continue;
    HalfRecord& record = partial.second[block + n];
    double force[half_record] = {record.x, record.y, record.z, record.w};
    weigh<B, D>(grid, gravity, partial.first + block, node, in_block, force);
    record = {force[0], force[1], force[2], force[3]};
  }
}

/// Halves of the records of some blocks; `buffers` of them are kept by the host at once.
template <int D, int buffers>
class NodeExchange {
 public:
  /// From now on, of these blocks; `find(blocks, count, tiles)` finds the tiles or patches around
  /// each.
  template <class F>
  void choose(const std::vector<NodeBlockPlace<D>>& blocks, F&& find) {
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
    find(blocks_.data(), count_, tiles_.data());
    for (PinnedArray<HalfRecord>& packed : packed_)
      if (packed.size() < nodes_) packed.allocate(nodes_ + nodes_ / 8);
    on_device_.need(nodes_);
  }
  const std::int32_t* tiles() const { return tiles_.data(); }
  std::size_t blocks() const { return count_; }
  double* of_host(int buffer) { return reinterpret_cast<double*>(packed_[buffer].data()); }

  template <class Places>
  const double* read(const Places& places, int buffer) {
    if (nodes_ == 0) return nullptr;
    launch(exchange_nodes<D, true, Places>, static_cast<unsigned>(count_), 128, blocks_.data(),
           places, on_device_.data());
    check_cuda(cudaMemcpy(packed_[buffer].data(), on_device_.data(), nodes_ * sizeof(HalfRecord),
                          cudaMemcpyDeviceToHost),
               "giving nodes to the host");
    return of_host(buffer);
  }
  template <class Places>
  void write(const Places& places, int buffer) {
    if (nodes_ == 0) return;
    // It waits: the host may fill the buffer anew at once.
    check_cuda(cudaMemcpy(on_device_.data(), packed_[buffer].data(), nodes_ * sizeof(HalfRecord),
                          cudaMemcpyHostToDevice),
               "taking nodes of the host");
    launch(exchange_nodes<D, false, Places>, static_cast<unsigned>(count_), 128, blocks_.data(),
           places, on_device_.data());
  }

 private:
  std::size_t count_ = 0, nodes_ = 0;
  DeviceArray<NodeBlockPlace<D>> blocks_;
  DeviceArray<std::int32_t> tiles_;
  DeviceArray<HalfRecord> on_device_;
  PinnedArray<HalfRecord> packed_[buffers];
};

}  // namespace mpm
