#pragma once
// Lists of particles by cell, patches and tiles of nodes, made on the device. Where something is
// counted or appended in no order, what follows puts it in order: by cells and by particles'
// numbers all lists are those of the host.
#include "mpm/device/cuda/gather.cuh"
#include "mpm/device/cuda/memory.cuh"
#include "mpm/device/device_run.hpp"

namespace mpm {

/// The lists of a run on the device, and what is needed to make them.
template <int D>
class DeviceLists {
 public:
  static constexpr std::size_t cells = Tile<D>::cell_count, around = Tile<D>::neighbours;

  explicit DeviceLists(bool reaches_before) : reaches_before_(reaches_before) {}

  /// Lists of particles that have been in none: `keys` and `rows` of their patches and their rows,
  /// in any order; of `row_count` rows in all pools. `bodies`, `pools` are those of ParticleStep.
  void start(const GridGeometry<D>& grid, const DeviceBody* bodies, const ParticleView<D>* pools,
             DeviceArray<std::uint64_t>& keys, DeviceArray<std::uint32_t>& rows, std::size_t count,
             std::size_t row_count, std::size_t body_count, void* room);
  /// Get ready for a step's moves. `room`: eight bytes for each particle, until they are finished.
  MoveView begin_moves(void* room);
  /// After they have been made; the lists anew if that is needed. `changed`, `homeless`: what the
  /// moves have counted; `gone`: some particles take no part any more.
  void finish_moves(const GridGeometry<D>& grid, const OutflowBox<D>& box, const DeviceBody* bodies,
                    const ParticleView<D>* pools, bool changed, std::uint32_t homeless, bool gone);
  /// What the moves have counted: changed, homeless, to be read by the host when they are done.
  const std::uint32_t* counters() const { return counters_.data(); }

  /// The numbers of the tiles of nodes, or of the patches, around each block, -1 where there is
  /// none.
  void find_node_tiles(const NodeBlockPlace<D>* blocks, std::size_t count, std::int32_t* to) const;
  void find_patches(const NodeBlockPlace<D>* blocks, std::size_t count, std::int32_t* to) const;

  ListView<D> view() const;
  NodeTileView<D> nodes(double* records) const;
  std::size_t patches() const { return patches_; }
  std::size_t node_tiles() const { return tiles_; }
  std::size_t particles() const { return particles_; }
  std::uint32_t* order() { return order_.data(); }
  /// Room for a number of each row, between steps.
  std::uint32_t* spare() { return next_order_.data(); }
  const std::uint32_t* patch_of_body() const { return patch_of_body_.data(); }
  const std::uint32_t* tile_of_body() const { return tile_of_body_.data(); }
  /// Entries whose row does not follow that of the one before, since the lists were last made.
  std::uint32_t* jumps() { return counters_.data() + 2; }

 private:
  void make_tables(std::size_t given, std::size_t body_count);
  void add_patches(std::size_t lost);
  /// How many keys are different, and these in their order; `keys` are lost.
  std::size_t sort_unique(DeviceArray<std::uint64_t>& keys, std::size_t count,
                          DeviceArray<std::uint64_t>& unique);
  void place(const std::uint32_t* rows, const DeviceBody* bodies, const ParticleView<D>* pools);

  bool reaches_before_;
  std::size_t particles_ = 0, patches_ = 0, tiles_ = 0, bodies_ = 0;
  DeviceArray<std::uint64_t> patch_keys_, tile_keys_, spare_keys_, sorted_keys_, homeless_keys_;
  DeviceArray<std::int32_t> patch_body_, tile_body_, patch_beside_, nodes_beside_, holders_,
      tile_beside_;
  DeviceArray<Index<D>> patch_tile_, tile_tile_;
  DeviceArray<std::uint32_t> order_, next_order_, counts_, cell_begin_, counters_, patch_of_body_,
      tile_of_body_;
  DeviceArray<std::byte> scratch_;
  std::uint32_t *target_ = nullptr, *slot_ = nullptr;
};

}  // namespace mpm
