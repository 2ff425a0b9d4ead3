#pragma once
// The sparse, unbounded grid: patches sorted by body and tile, who their neighbours are, and the
// memory of their nodes. Data; what is done with it is in connect.hpp, blocks.hpp and
// sum_shared_nodes.hpp.
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/fields/lists.hpp"
#include "mpm/grid/geometry.hpp"
#include "mpm/grid/node_memory.hpp"
#include "mpm/grid/outflow_box.hpp"
#include "mpm/grid/partition.hpp"

namespace mpm {

template <int D>
struct TileGrid : GridGeometry<D> {
  OutflowBox<D> outflow_box;
  bool has_dashpots = false;      // the blocks have room for those of absorbing walls
  bool has_wall_springs = false;  // and for those of walls that touch
  // Of each body, where walls hold some and push back others; else empty: `walls` of all.
  std::vector<Walls<D>> walls_of_bodies;
  bool bonded = false;            // all bodies have one velocity field: they share their nodes
  std::vector<Patch<D>> patches;  // by body, then by tile
  Partition<D> partition;

  // Made by connect().
  std::vector<std::uint32_t> by_tile;    // if bonded: all patches, by tile, those that lead first
  std::vector<std::uint32_t> primaries;  // those whose nodes are summed with their neighbours'

  // Made by cut_blocks().
  NodeMemory nodes;
  NodeMemory kept;  // of the patches that keep their nodes
  SharedLists<D> shared;
  std::vector<std::uint8_t> reshaped;  // scratch: of each patch, its block is another than before
  std::size_t patches_with_particles = 0, records_with_particles = 0;  // records: of their nodes
  bool blocks_known = false;  // the blocks are those of the patches there are

  const Walls<D>& walls_of(int body) const {
    return walls_of_bodies.empty() ? this->walls : walls_of_bodies[static_cast<std::size_t>(body)];
  }

  NodeBlock<D> block(const Patch<D>& patch) {
    const int count = patch.shape.node_count;
    if (patch.keeps) {
      double* const first = kept.numbers.data() + patch.memory;
      return {{first}, count, {nullptr}, {first + std::ptrdiff_t{count} * record}};
    }
    double* const begin = nodes.numbers.data() + patch.memory;
    const bool touches = has_wall_springs && patch.at_wall;
    return {{begin}, count, {touches ? begin + numbers_before_springs(count) : nullptr}};
  }
  NodeBlock<D> block(std::size_t patch) { return block(patches[patch]); }
  /// Of a block that keeps its nodes: records, then displacements.
  static std::size_t numbers_kept(int count) {
    const auto nodes = static_cast<std::size_t>(count);
    return record * (nodes + (nodes + 1) / 2);
  }
  /// Of a block of so many nodes, in whole cache lines: all, and those before the springs of walls.
  std::size_t numbers_of_block(int count, bool at_wall) const {
    const auto nodes = static_cast<std::size_t>(count);
    const bool touches = has_wall_springs && at_wall;
    return numbers_before_springs(count) + (touches ? record * ((3 * nodes + 1) / 2) : 0);
  }
  std::size_t numbers_before_springs(int count) const {
    const auto nodes = static_cast<std::size_t>(count);
    return record * (nodes + (has_dashpots ? (nodes + 1) / 2 : 0));
  }
};

/// What the patches with particles and their nodes need, of all ranks.
template <int D>
std::size_t needed_bytes(const TileGrid<D>& grid) {
  const std::size_t here = grid.records_with_particles * record * sizeof(double) +
                           grid.patches_with_particles * sizeof(Patch<D>);
  return static_cast<std::size_t>(all_sum(*grid.partition.comm, static_cast<std::int64_t>(here)));
}
/// How many patches of all ranks have particles.
template <int D>
std::size_t all_patches(const TileGrid<D>& grid) {
  return static_cast<std::size_t>(
      all_sum(*grid.partition.comm, static_cast<std::int64_t>(grid.patches_with_particles)));
}
/// What they have taken.
template <int D>
std::size_t bytes_of(const TileGrid<D>& grid) {
  return grid.nodes.numbers.bytes() + grid.kept.numbers.bytes() + grid.shared.entries.bytes() +
         grid.shared.aside.bytes() + bytes_of(grid.patches);
}

}  // namespace mpm
