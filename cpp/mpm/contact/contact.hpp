#pragma once
// What contact works on: plain data. A step goes through it in this order:
//   candidates.hpp    the tiles whose nodes two or more bodies touch, when patches come or go;
//   find_touches.hpp  with springs, the particles that overlap another body;
//   find_nodes.hpp    the overlapped nodes, and who is there;
//   find_pairs.hpp    normals and gaps of the pairs at a node, eq. (5), by the rules of normal.hpp
//                     and detection.hpp;
//   pair_cache.hpp    what of it is kept from step to step;
//   rigid_masses.hpp  the masses with which bodies that do not deform meet others;
//   respond.hpp       velocities and forces, eqs. (6)-(7), (11)-(15), by node_solver.hpp;
//   record.hpp        what has passed between the bodies, pair by pair.
// Before the first step set_back.hpp sees to bodies that overlap already.
#include <array>
#include <atomic>
#include <cstdint>

#include "mpm/contact/contact_part.hpp"
#include "mpm/contact/pair_cache.hpp"
#include "mpm/contact/pair_records.hpp"
#include "mpm/contact/settings.hpp"
#include "mpm/contact/tile_holder.hpp"
#include "mpm/contact/tile_shares.hpp"
#include "mpm/contact/touch.hpp"

namespace mpm {

/// A tile whose nodes two or more bodies touch.
template <int D>
struct ContactTile {
  Index<D> tile;
  std::uint32_t first_holder, holders;
  std::uint64_t cached = 0;  // the nodes that were overlapped in the last step, by Tile<D>::cell
  std::uint32_t cached_part = 0;   // where they are cached: a number of Contact::parts
  std::uint32_t first_cached = 0;  // the first of them, of ContactPart::cached_nodes
  TouchRange touches;              // with springs: of particles in the tile, in this step
  std::uint8_t node_count = 0;     // that were overlapped in the last step, with springs touched
  bool beside_others = false;      // a tile around it belongs to another rank
  bool held_by_others = false;     // some holder does
};

/// A tile of another rank beside one of contact, and which of Contact::foreign_touches lie there.
template <int D>
struct ForeignTile {
  Index<D> tile;
  std::uint32_t first = 0, count = 0;
};

/// The cells of a foreign patch of which contact here looks at the particles.
struct WantedCells {
  std::uint32_t patch;
  std::uint64_t cells;
};

/// Letters of contact.
struct ContactMail {
  Mail asked, told, touches, responses;
};

/// Sums over all contacts of one step, for the ledger [J].
struct ContactSums {
  double friction = 0.0;        // lost to friction
  double friction_first = 0.0;  // the same with the slip at the start of the step
  double energy = 0.0;          // lost in normal contact, or stored in its springs
  double force_work =
      0.0;              // work of contact forces at the velocities that the nodal forces work on
  double stored = 0.0;  // in springs, after the step
};

/// Numbers of nodes and bodies.
struct ContactCounts {
  std::size_t overlapped = 0;      // nodes in this step
  std::size_t overlapped_max = 0;  // since the start
  int bodies_max = 0;              // at a node, since the start
};

/// Particles whose surfaces were set back before the first step.
struct SetBack {
  std::size_t particles = 0;
  double most = 0.0;  // [m]
};

template <int D>
struct Contact {
  std::vector<TileHolder> holders;    // those of each tile follow one another
  std::vector<ContactTile<D>> tiles;  // of this rank
  NodesWithMass<D> masses;            // of the step
  // With springs: the numbers of the tiles around each, foreign ones behind those of this rank, -1
  // if none; and the touches of the step.
  std::vector<std::array<std::int32_t, Tile<D>::neighbours>> around;
  std::vector<std::vector<Touch<D>>> touches;
  std::vector<ForeignTile<D>> foreign_tiles;  // in their order
  std::vector<Touch<D>> foreign_touches;      // by tile
  std::vector<WantedCells> wanted;
  ContactMail mail;
  std::vector<std::uint8_t> surface_ranges;  // scratch, by patch: SurfaceSum::range()
  std::vector<ContactPart<D>> parts;
  PairCache cache;
  PairRecords records;
  // Bodies on nodes of their own, and those that do not deform, meet by their surfaces, not here.
  bool leaves_surfaces = false;
  bool has_rigid = false;       // some body does not deform
  bool has_free_rigid = false;  // and moves by what pushes it
  ContactCounts counts;
  SetBack set_back;
  /// Solutions at nodes with several bodies that stopped short of the tolerance, since the start.
  std::atomic<std::size_t> unconverged{0};
  std::vector<ContactTile<D>> last_tiles;  // scratch
  std::vector<std::int32_t> sorted_tiles;  // scratch
  std::vector<ExactSum> rigid_share;       // scratch: the mass of each free rigid body at its nodes
};

/// Memory that it holds [bytes].
template <int D>
std::size_t bytes_of(const Contact<D>& contact) {
  std::size_t parts = 0;
  for (const ContactPart<D>& part : contact.parts) parts += part.bytes();
  for (const auto& touches : contact.touches) parts += bytes_of(touches);
  return contact.masses.bytes() + parts + contact.cache.bytes() + contact.records.bytes() +
         bytes_of(contact.around) + bytes_of(contact.touches) + bytes_of(contact.surface_ranges) +
         bytes_of(contact.sorted_tiles) + bytes_of(contact.holders) + bytes_of(contact.tiles) +
         bytes_of(contact.last_tiles) + bytes_of(contact.rigid_share);
}

/// Drop the overlapped nodes of the last step, which name tiles by their numbers.
template <int D>
void forget_nodes(Contact<D>& contact) {
  for (ContactPart<D>& part : contact.parts) part.nodes.clear();
}

/// Grid coordinates of a node.
template <int D>
Index<D> place_of(const Contact<D>& contact, const TileGrid<D>& grid, const ContactNode& node) {
  const Index<D> index = Tile<D>::cell_index(node.cell);
  Index<D> place = grid.first_cell(contact.tiles[node.tile].tile);
  for (std::size_t a = 0; a < D; ++a) place[a] += index[a];
  return place;
}

/// The vector at number `at` of the record of a side's node.
template <int D>
Vec<double, D> read(TileGrid<D>& grid, const BodyAtNode<D>& side, int at) {
  const double* const numbers = grid.nodes.record_at(side.place) + at;
  Vec<double, D> value;
  for (int a = 0; a < D; ++a) value[a] = numbers[a];
  return value;
}

/// The records and what is cached, saved or restored; the tiles must have been connected. Throws
/// std::invalid_argument if what is restored is of no such contact.
template <int D>
void exchange_contact(Contact<D>& contact, StateStream& stream, std::size_t bodies,
                      const Partition<D>& partition);

}  // namespace mpm
