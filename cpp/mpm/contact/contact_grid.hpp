#pragma once
// Where bodies overlap: the tiles whose nodes two or more bodies touch, and, anew in every step,
// the overlapped nodes.
#include <atomic>
#include <cstdint>
#include <limits>

#include "mpm/contact/contact_part.hpp"
#include "mpm/contact/near_particles.hpp"
#include "mpm/contact/node_solver.hpp"
#include "mpm/contact/settings.hpp"
#include "mpm/fields/state_stream.hpp"

namespace mpm {

/// A tile whose nodes two or more bodies touch.
template <int D>
struct ContactTile {
  Index<D> tile;
  std::uint32_t first_holder, holders;
  std::uint64_t known = 0;  // the nodes that were overlapped in the last step, by Tile<D>::cell
  std::uint32_t known_part = 0;   // where they are known: a number of ContactGrid::parts_
  std::uint32_t first_known = 0;  // the first of them, of ContactPart::known_nodes
};

/// What has passed between two bodies since the start.
struct PairRecord {
  int a = 0, b = 0;        // bodies, a < b; or groups of bodies, a <= b
  std::int64_t pairs = 0;  // of bodies, that the record is the sum of
  double first_time = std::numeric_limits<double>::quiet_NaN();  // [s]
  // Of the first contact [m]: the distance of the surfaces, the unit vector from a to b along which
  // it was measured and acted, and the position of the node.
  double first_gap = std::numeric_limits<double>::quiet_NaN();
  double first_normal[3] = {}, first_node[3] = {};
  double first_share = 0.0;  // mass of the node of first_gap over a particle's
  std::int64_t first_step = -1;
  double force[3] = {};        // on a, in the last step [N]
  double impulse[3] = {};      // on a [N s]
  double friction_work = 0.0;  // [J]
};

/// The node at which most bodies meet.
struct Crowd {
  int bodies = 0;           // at the node
  int body = -1;            // one of them
  double position[3] = {};  // of the node [m]
};

/// Sums over all contacts of one step, for the ledger [J].
struct ContactSums {
  double friction = 0.0;        // lost to friction
  double friction_first = 0.0;  // the same with the slip at the start of the step
  double energy = 0.0;          // lost in normal contact
  double force_work =
      0.0;  // work of contact forces at the velocities that the nodal forces work on
};

/// A body around a tile, while the tile's overlapped nodes are found.
template <int D>
struct TileBody {
  std::int32_t body;
  std::uint32_t first_holder, holders;
  std::uint64_t nodes;  // where it has mass, a bit each by Tile<D>::cell
  TileParticles<D> particles;
};

/// The bodies around a tile: scratch of one thread, not counted among the bytes of the contact.
template <int D>
struct TileBodies {
  std::vector<TileBody<D>> bodies;  // the first `count` are in use
  std::size_t count = 0;
  std::uint64_t overlapped = 0;    // nodes at which two or more have mass
  std::vector<HeldNodes<D>> held;  // by the holders, in the order of the tile's

  std::span<TileBody<D>> all() { return {bodies.data(), count}; }
  std::span<const TileBody<D>> all() const { return {bodies.data(), count}; }
  std::span<const HeldNodes<D>> held_by(const TileBody<D>& body) const {
    return {&held[body.first_holder - bodies.front().first_holder], body.holders};
  }
  TileBody<D>& with(std::int32_t body) {
    return *std::ranges::find(all(), body, &TileBody<D>::body);
  }
};

template <int D>
class ContactGrid {
 public:
  /// Find the tiles where bodies may meet, one of them deforming, and mark the patches that may
  /// have nodes there. Call when patches were added or removed.
  void connect(TileGrid<D>& grid, const std::vector<Body<D>>& bodies);
  /// Find all normals and gaps anew, as after a change of the cells.
  void forget();

  /// Find the overlapped nodes with their normals, pairs and gaps, eq. (5). Needs mass and velocity
  /// at the nodes, and the length of the step that begins.
  void find(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, const ContactSettings& settings,
            double time_step, Threads& threads);

  /// Remove approaching momentum, eqs. (6)-(7), from the nodal velocities.
  void adjust_momentum(TileGrid<D>& grid, Threads& threads);
  /// Add the contact forces, eqs. (11)-(15), to the nodal forces; `gravity` is the body force per
  /// mass.
  void add_forces(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const Vec<double, D>& gravity, double time_step, Threads& threads);
  /// Remove the approach from the remapped velocities (3.6, step 10).
  void adjust_remapped(TileGrid<D>& grid, Threads& threads);

  /// Add this step's impulses and work to the records of the pairs and give the sums for the
  /// ledger.
  ContactSums record(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, double time,
                     double time_step, std::int64_t step);

  /// The records, and what is kept from step to step; the tiles must have been connected. Throws
  /// std::invalid_argument if what is restored is of no such contact.
  void exchange(StateStream& stream, std::size_t bodies);

  const std::vector<PairRecord>& pairs() const { return records_; }
  std::size_t overlapped_nodes() const { return overlapped_; }
  std::size_t overlapped_nodes_max() const { return nodes_max_; }
  int bodies_per_node_max() const { return bodies_max_; }
  /// Of the nodes of this step where bodies may act on each other.
  Crowd crowd(const TileGrid<D>& grid) const;
  /// Solutions at nodes with several bodies that stopped short of the tolerance, since the start.
  std::size_t unconverged() const { return unconverged_.load(); }
  std::size_t bytes() const;

 private:
  using Part = ContactPart<D>;
  void recall_tiles();
  /// The bodies around a tile and the nodes at which they overlap.
  void look_around(const TileGrid<D>& grid, const ContactTile<D>& tile, TileBodies<D>& found) const;
  std::span<const TileHolder> holders_of(const TileBody<D>& at) const {
    return {&holders_[at.first_holder], at.holders};
  }
  /// Have the memory bring the particles around nodes of a tile, a bit each by Tile<D>::cell.
  void fetch_particles(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                       const TileBodies<D>& around, std::uint64_t nodes) const;
  /// Where the sides of a node are, their masses and velocities left to be read.
  void place_sides(TileGrid<D>& grid, const TileBodies<D>& around, Part& part, ContactNode& node);
  void read_sides(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, Part& part,
                  ContactNode& node);
  /// The overlapped nodes of a tile, their sides read and their pairs empty.
  void add_nodes(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, std::size_t tile,
                 TileBodies<D>& around, Part& part);
  /// Add to travel_ what the fastest node of each body says.
  void add_travel(std::size_t bodies);
  /// Take over what is known of the pairs at a node, if it still holds; else false.
  bool recall(const std::vector<Body<D>>& bodies, const ContactSettings& settings, double cell_size,
              const ContactTile<D>& tile, Part& part, const ContactNode& node);
  /// Normals, gaps and frictions of the pairs at the nodes of a tile, those of a part from the
  /// first-th on: known ones that still hold, else found.
  void fill_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const ContactSettings& settings, std::size_t tile, TileBodies<D>& around,
                  std::size_t part, std::size_t first);
  /// The vector at number `at` of the record of a side's node; and write it to all copies.
  Vec<double, D> read(TileGrid<D>& grid, const Side<D>& side, int at) const;
  void write(TileGrid<D>& grid, const Part& part, const Side<D>& side, const Vec<double, D>& value,
             int at) const;
  /// Grid coordinates of a node.
  Index<D> place_of(const TileGrid<D>& grid, const ContactNode& node) const {
    const Index<D> index = Tile<D>::cell_index(node.cell);
    Index<D> place = grid.first_cell(tiles_[node.tile].tile);
    for (std::size_t a = 0; a < D; ++a) place[a] += index[a];
    return place;
  }
  Vec<double, D> prescribed_increment(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                      const ContactNode& node, const Side<D>& side) const;
  template <bool with_friction>
  void solve(NodeSolution<D>& solution);
  /// Normals, gaps and frictions of the pairs at a node whose sides are known.
  void find_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const ContactSettings& settings, TileBodies<D>& around, Part& part,
                  const ContactNode& node);
  void remember_pairs(Part& part, const ContactNode& node);
  double travel_of(std::span<const Side<D>> sides, const SidePair<D>& pair) const;
  /// Change the gaps that are known by what the bodies do in this step.
  void move_gaps(Part& part, const ContactNode& node, const NodeSolution<D>& solution,
                 double time_step);
  /// f(pair, known, sign) for the pairs at a node and their entries among those of the node, which
  /// come by the numbers of the bodies: `sign` is that of the normal.
  template <class Known, class F>
  void for_each_known(Part& part, const ContactNode& node, Known* known, F&& f);
  void start_pair(const std::vector<Body<D>>& bodies, const ContactSettings& settings,
                  std::span<const Side<D>> sides, std::uint16_t r, std::uint16_t s,
                  SidePair<D>& pair) const;
  /// A rigid body meets others with its whole mass, spread over its overlapped nodes; one whose
  /// motion is prescribed mostly with an infinite mass.
  void share_rigid_masses(const std::vector<Body<D>>& bodies);
  /// f(part, node) for the nodes where any pair may act. The memory is told of them in time.
  template <class F>
  void for_each_closed(TileGrid<D>& grid, Threads& threads, F&& f);
  PairRecord& record_of(int a, int b);
  void enter(std::size_t record);
  void sort_records();

  NodesWithMass<D> masses_;
  std::vector<TileHolder> holders_;
  std::vector<ContactTile<D>> tiles_;
  std::vector<Part> parts_;
  bool keeps_ = false;  // pairs are kept from step to step: ContactSettings::normal_travel > 0
  std::vector<double> travel_, fastest_;    // way of each body so far [m], and its speed [m/s]
  std::vector<ContactTile<D>> last_tiles_;  // scratch
  double last_time_step_ = 0.0;             // [s]
  std::vector<double> rigid_share_;         // scratch
  std::vector<PairRecord> records_;         // sorted by (a, b) between steps
  // Where a pair's record is: open addressing by pair_key, at most half full; 0 is empty, else the
  // record's number + 1.
  std::vector<std::uint32_t> places_;
  std::size_t overlapped_ = 0, nodes_max_ = 0;
  int bodies_max_ = 0;
  std::atomic<std::size_t> unconverged_{0};
};

template <int D>
Vec<double, D> ContactGrid<D>::read(TileGrid<D>& grid, const Side<D>& side, int at) const {
  const double* const numbers = grid.record_at(side.place) + at;
  Vec<double, D> value;
  for (int a = 0; a < D; ++a) value[a] = numbers[a];
  return value;
}

template <int D>
void ContactGrid<D>::write(TileGrid<D>& grid, const Part& part, const Side<D>& side,
                           const Vec<double, D>& value, int at) const {
  part.for_each_place(side, [&](std::uint32_t place) {
    double* const numbers = grid.record_at(place);
    for (int a = 0; a < D; ++a) numbers[at + a] = value[a];
  });
}

}  // namespace mpm
