#pragma once
// The sparse, unbounded grid: patches sorted by body and tile, who their neighbours are, and the
// memory of their nodes.
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "mpm/fields/memory_space.hpp"
#include "mpm/fields/state_stream.hpp"
#include "mpm/grid/outflow_box.hpp"
#include "mpm/grid/patch.hpp"
#include "mpm/math/vec.hpp"
#include "mpm/parallel/threads.hpp"
#include "mpm/walls/walls.hpp"

namespace mpm {

/// From positions to cells. Every kernel uses this one expression, so that all agree on cells.
template <int D>
struct CellCoordinates {
  Vec<double, D> origin;
  double cells_per_metre;

  template <class T>
  T in_cells(T x, int axis) const {
    return (x - T(origin[axis])) * T(cells_per_metre);
  }
};

/// Position within the cell, in [1e-12, 1 - 1e-12], from the position in cells and the cell's
/// coordinate. A particle exactly on a cell's face would give force to nodes to which it gives no
/// mass; it is held 1e-12 cells away.
template <class T>
T local_coordinate(T cells, double cell) {
  constexpr double from_face = 1e-12;
  return min(max(cells - T(cell), T(from_face)), T(1.0 - from_face));
}

template <int D>
class TileGrid {
 public:
  Vec<double, D> origin = Vec<double, D>::zero();  // position of node 0 [m]
  double cell_size = 0.0;                          // [m]
  BasisId basis = basis_id<Linear>;                // of all bodies
  // Cell at the lower corner of tile 0. Tied to the particles' first place, so that a problem
  // shifted by whole cells is cut into the same tiles and gives the same bits.
  Index<D> anchor{};
  Walls<D> walls;
  OutflowBox<D> outflow_box;
  bool has_dashpots = false;      // the blocks have room for those of absorbing walls
  bool bonded = false;            // all bodies have one velocity field: they share their nodes
  std::vector<Patch<D>> patches;  // by body, then by tile

  CellCoordinates<D> coordinates() const {
    Vec<double, D> corner = origin;
    for (int a = 0; a < D; ++a) corner[a] -= reach().own_node * cell_size;
    return {corner, 1.0 / cell_size};
  }
  /// Position along an axis in cells from the corner of cell 0.
  template <class T>
  T in_cells(T x, int axis) const {
    return coordinates().in_cells(x, axis);
  }
  /// The same from node 0: between which nodes it is.
  double among_nodes(double x, int axis) const {
    return CellCoordinates<D>{origin, 1.0 / cell_size}.in_cells(x, axis);
  }
  /// Cell coordinates of a position.
  Index<D> cell_of(const Vec<double, D>& x) const {
    const CellCoordinates<D> cells = coordinates();
    Index<D> i;
    for (int a = 0; a < D; ++a)
      i[a] = static_cast<std::int32_t>(std::floor(cells.in_cells(x[a], a)));
    return i;
  }
  /// Position of a node [m].
  Vec<double, D> position_of(const Index<D>& node) const {
    Vec<double, D> x;
    for (int a = 0; a < D; ++a) x[a] = origin[a] + cell_size * node[a];
    return x;
  }
  Index<D> tile_of(const Index<D>& cell) const {
    Index<D> t;
    for (int a = 0; a < D; ++a) {
      const int i = cell[a] - anchor[a];
      t[a] = i >= 0 ? i / Tile<D>::cells : -((Tile<D>::cells - 1 - i) / Tile<D>::cells);
    }
    return t;
  }
  /// Coordinates of a tile's first cell, which are those of that cell's own node too.
  Index<D> first_cell(const Index<D>& tile) const {
    Index<D> c;
    for (int a = 0; a < D; ++a) c[a] = anchor[a] + tile[a] * Tile<D>::cells;
    return c;
  }

  /// Nodes around a cell's own that its particles reach.
  Reach reach() const { return reach_of(basis); }
  /// Do nodes beyond walls follow their images before them?
  bool has_ghosts() const { return walls.exist && reach().before > 0; }
  NodeBlock<D> block(std::size_t patch) { return block_of(patches[patch]); }
  /// A node's record as a number, for those who come back to it before blocks are cut anew.
  std::uint32_t index_of_record(const double* at) const {
    return static_cast<std::uint32_t>((at - node_memory_.data()) / record);
  }
  double* record_at(std::uint32_t place) {
    return node_memory_.data() + std::size_t{place} * record;
  }
  /// What the patches and their nodes need now.
  std::size_t needed_bytes() const {
    return needed_ * sizeof(double) + patches.size() * sizeof(Patch<D>);
  }
  void release_nodes() {
    node_memory_.release_and_allocate(0);
    shared_.release_and_allocate(0);
    listed_ = 0;
  }
  /// The memory of the nodes, for others until momentum is mapped. All values in it are lost.
  std::span<std::byte> idle_memory() {
    return std::as_writable_bytes(std::span(node_memory_.data(), node_memory_.size()));
  }
  std::size_t node_bytes() const {
    return node_memory_.bytes() + shared_.bytes() + patches.capacity() * sizeof(Patch<D>);
  }

  /// Find neighbours. Call when patches were added or removed; there are no blocks then until they
  /// have been cut.
  void connect();
  /// Cut the blocks to the cells that hold particles, find the owners of shared nodes and the
  /// walls, and make room for the nodes. Call when particles have changed cells.
  void cut_blocks(Threads& threads);
  /// What a run has made of the grid and its patches. Restored, they must be connected and cut.
  void exchange(StateStream& stream);
  /// The patch of a body in a tile, or -1.
  int find(int body, const Index<D>& tile) const;

  /// Add up what the patches sharing a node have put there, for numbers [first, last) of the
  /// records, half a record or a whole, always in the order of the tiles (of bonded bodies in one
  /// tile: of the bodies); then every patch holds the sum.
  void sum_shared_nodes(Threads& threads, int first, int last);
  /// The same for the dashpots.
  void sum_shared_dashpots(Threads& threads);

 private:
  NodeBlock<D> block_of(const Patch<D>& patch) {
    return {{node_memory_.data() + patch.memory}, patch.shape.node_count};
  }
  bool before(const Patch<D>& p, int body, const Index<D>& tile) const;
  void choose_primaries();
  bool find_shapes(Threads& threads);
  void find_outdated(Threads& threads);
  void find_owned(Patch<D>& patch) const;
  void list_shared_nodes(Threads& threads);
  /// `begin_of(patch)`: the first of the numbers of its nodes that are summed, so many halves.
  template <int halves, int width, class F>
  void sum_shared_nodes_of(const Patch<D>& patch, F&& begin_of);
  template <int halves, int width, class F>
  void sum_shared(Threads& threads, F&& begin_of);
  template <class F>
  void for_each_secondary(Threads& threads, F&& f);
  template <class F>
  void for_each_shared(const Patch<D>& patch, F&& f) const;

  AlignedArray<double> node_memory_;
  std::size_t needed_ = 0;                         // of it [doubles]
  AlignedArray<SharedEntry<D>> shared_;            // SharedNodes of all patches
  std::size_t listed_ = 0;                         // entries of it that are in use
  std::vector<std::uint8_t> reshaped_, outdated_;  // scratch: of each patch, its block, its lists
  std::vector<std::size_t> listed_before_;         // scratch: where each patch's list was
  bool blocks_known_ = false;                      // the blocks are those of the patches there are
  std::vector<std::uint32_t> by_tile_;             // if bonded: all patches, by tile, then by body
  std::vector<std::uint32_t> primaries_;  // those whose nodes are summed with their neighbours'
};

/// Order of patches: by body, then by tile.
template <int D>
bool patch_less(int body_x, const Index<D>& x, int body_y, const Index<D>& y) {
  return body_x != body_y ? body_x < body_y : tile_less<D>(x, y);
}

}  // namespace mpm
