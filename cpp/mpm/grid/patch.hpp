#pragma once
// The patch: one body's particles in one tile, with that body's nodal block. The unit of work of
// every stage.
#include <bit>
#include <cstdint>

#include "mpm/grid/shared_lists.hpp"
#include "mpm/layout/node_bits.hpp"
#include "mpm/layout/node_records.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// The nodes of a patch, their fields by name; which of them share a place, and until when one is
/// there, stands beside `momentum_at`. Dashpots exist where walls absorb: factors, then forces;
/// springs in patches at walls that touch, then the forces of these.
template <int D>
struct NodeBlock {
  NodeRecords records;
  int count;
  WallRecords springs{nullptr};  // behind records and dashpots, if it is at a wall that touches
  HalfRecords displacements{nullptr};  // behind the records, of a patch that keeps its nodes [m]
  NodeField<record> mass() const { return {records.data + mass_at}; }                   // [kg]
  NodeField<record> momentum(int a) const { return {records.data + momentum_at + a}; }  // [kg m/s]
  NodeField<record> velocity(int a) const { return {records.data + velocity_at + a}; }  // [m/s]
  NodeField<record> ghost_weight(int a) const {                                         // [N]
    return {records.data + ghost_weight_at + a};
  }
  NodeField<record> force(int a) const { return {records.data + force_at + a}; }          // [N]
  NodeField<record> increment(int a) const { return {records.data + increment_at + a}; }  // [m/s]
  NodeField<record> remapped(int a) const { return {records.data + remapped_at + a}; }    // [m/s]
  NodeField<half_record> dashpot_factor(int a) const { return {dashpots().data + a}; }    // [kg/s]
  NodeField<half_record> dashpot_force(int a) const { return {dashpots().data + a}; }     // [N]
  /// Of the springs along an axis, and a component of the force of the face across it [N].
  NodeField<wall_record> spring(int at, int a) const { return {springs.data + at + a}; }
  NodeField<wall_record> face_force(int normal, int a) const {
    return {springs.data + std::ptrdiff_t{normal} * half_record + a};
  }
  /// The vector at number `at` of a node's record.
  Vec<double, D> vector(int node, int at) const {
    Vec<double, D> v;
    for (int a = 0; a < D; ++a) v[a] = records[node][at + a];
    return v;
  }
  HalfRecords dashpots() const { return {records[count]}; }  // behind the records
};

template <int D>
struct Patch {
  int body = 0;
  Index<D> tile{};              // coordinates of the tile
  std::uint32_t begin = 0;      // its range of its pool's lists
  std::uint32_t room = 0;       // entries of the range
  std::uint32_t count = 0;      // of its particles, in the first of them
  std::uint32_t first_row = 0;  // near which their rows lie, since the columns were last sorted
  std::uint64_t occupied = 0;   // bit c: cell c holds a particle
  std::array<std::uint32_t, Tile<D>::cell_count + 1> cell_begin{};  // relative to `begin`
  std::array<std::int32_t, Tile<D>::neighbours>
      neighbour{};  // patches of the same body around it, -1 if none; of a primary if bonded
  std::uint32_t primary =
      0;                   // where the bodies are bonded: the first patch of the tile; else itself
  BlockShape<D> shape;     // of its block; a primary's holds those of all that are secondary to it
  std::size_t memory = 0;  // where its block begins in the grid's memory [doubles]
  NodeBits<D> owned;      // nodes that no earlier patch of the body holds; of a primary, no earlier
                          // primary; none of a secondary one
  SharedNodes<D> shared;  // of a primary; of others it means nothing
  bool at_wall = false;   // its block has nodes on a wall, or next to one that touches
  bool keeps = false;     // its nodes keep their displacements and velocities
  bool left_cell = false;   // a particle has left its cell since the lists were made
  bool in_contact = false;  // its block may have nodes where bodies meet
  bool foreign = false;     // of another rank (partition.hpp): it has nodes here, but no particles
  int owner = 0;            // of a foreign one: that rank
  int readers = -1;         // of an own one: number of the set of ranks that hold it; -1: not known
  std::uint64_t foreign_cells = 0;  // of a foreign one: cells that hold particles
  std::uint8_t surface_range = 0;   // and how far their surface is felt [cells]

  /// The cells about which its nodes lie.
  std::uint64_t cells() const { return occupied | foreign_cells; }
  /// Does the node enter sums over nodes by this patch?
  bool counts(int node) const { return !foreign && owned[node]; }

  /// f(cell, first, last): every occupied cell with its range in the pool's lists.
  template <class F>
  void for_each_cell(F&& f) const {
    for (std::uint64_t left = occupied; left != 0; left &= left - 1) {
      const int c = std::countr_zero(left);
      const auto k = static_cast<std::size_t>(c);
      f(c, begin + cell_begin[k], begin + cell_begin[k + 1]);
    }
  }
};

/// Order of patches: by body, then by tile.
template <int D>
bool patch_less(int body_x, const Index<D>& x, int body_y, const Index<D>& y) {
  return body_x != body_y ? body_x < body_y : tile_less<D>(x, y);
}

}  // namespace mpm
