#pragma once
// Where bodies overlap: the tiles whose nodes two or more bodies touch, and, anew in every step,
// the overlapped nodes.
#include <atomic>
#include <cstdint>
#include <limits>

#include "mpm/contact/node_contact.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/particles/body.hpp"

namespace mpm {

/// A patch whose block has nodes that belong to a tile: the tile's own patch of a body, or one
/// beside it. (A tile's own nodes are all but those at its upper ends, which are the next tile's
/// first.)
struct TileHolder {
  std::int32_t body;
  std::int32_t patch;
  std::uint8_t neighbour;  // where the tile lies as seen from the patch: Tile<D>::offset
};

/// Coordinate in a holder's block of a node of the tile.
template <int D>
Index<D> seen_from(const TileHolder& holder, Index<D> node) {
  const Index<D> o = Tile<D>::offset(holder.neighbour);
  for (int a = 0; a < D; ++a) node[a] += Tile<D>::cells * o[a];
  return node;
}
/// Does a holder's patch have this node (counted from the tile's first) in its block?
template <int D>
bool holds_node(const BlockShape<D>& shape, const TileHolder& holder, const Index<D>& node) {
  return shape.holds(seen_from<D>(holder, node));
}
/// The node's number in the holder's block.
template <int D>
int node_in_holder(const BlockShape<D>& shape, const TileHolder& holder, const Index<D>& node) {
  return shape.node(seen_from<D>(holder, node));
}
template <int D>
struct ContactTile {
  Index<D> tile;
  std::uint32_t first_holder, holders;
};

/// What has passed between two bodies since the start.
struct PairRecord {
  int a = 0, b = 0;        // bodies, a < b; or groups of bodies, a <= b
  std::int64_t pairs = 0;  // of bodies, that the record is the sum of
  double first_time = std::numeric_limits<double>::quiet_NaN();  // [s]
  double first_gap = std::numeric_limits<double>::quiet_NaN();
  double first_share = 0.0;  // mass of the node of first_gap over a particle's
  std::int64_t first_step = -1;
  double force[3] = {};        // on a, in the last step [N]
  double impulse[3] = {};      // on a [N s]
  double friction_work = 0.0;  // [J]
};

/// Sums over all contacts of one step, for the ledger [J].
struct ContactSums {
  double friction = 0.0;        // lost to friction
  double friction_first = 0.0;  // the same with the slip at the start of the step
  double energy = 0.0;          // lost in normal contact
  double force_work =
      0.0;  // work of contact forces at the velocities that the nodal forces work on
};

template <int D>
class ContactGrid {
 public:
  /// Find the tiles where bodies may meet, one of them deforming, and mark the patches that have
  /// nodes there. Call when patches were added or removed.
  void connect(TileGrid<D>& grid, const std::vector<Body<D>>& bodies);

  /// Find the overlapped nodes with their normals, pairs and gaps, eq. (5). Needs mass and velocity
  /// at the nodes.
  void find(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
            const std::vector<double>& stiffness, const ContactSettings& settings,
            Threads& threads);

  /// Remove approaching momentum, eqs. (6)-(7), from the nodal velocities.
  void adjust_momentum(TileGrid<D>& grid, Threads& threads);
  /// Add the contact forces, eqs. (11)-(15), to the nodal forces; `gravity` is the body force per
  /// mass.
  void add_forces(TileGrid<D>& grid, const Vec<double, D>& gravity, double time_step,
                  Threads& threads);
  /// Remove the approach from the remapped velocities (3.6, step 10).
  void adjust_remapped(TileGrid<D>& grid, Threads& threads);

  /// Add this step's impulses and work to the records of the pairs and give the sums for the
  /// ledger.
  ContactSums record(const std::vector<Body<D>>& bodies, double time, double time_step,
                     std::int64_t step);

  const std::vector<PairRecord>& pairs() const { return records_; }
  std::size_t overlapped_nodes() const { return nodes_.size(); }
  std::size_t overlapped_nodes_max() const { return nodes_max_; }
  int bodies_per_node_max() const { return bodies_max_; }
  /// Solutions at nodes with several bodies that stopped short of the tolerance, since the start.
  std::size_t unconverged() const { return unconverged_.load(); }
  std::size_t bytes() const;

 private:
  std::uint32_t sides_at(TileGrid<D>& grid, const ContactTile<D>& tile, const Index<D>& node,
                         Side<D>* sides);
  template <class F>
  void for_each_copy(const TileGrid<D>& grid, const ContactNode& node, const Side<D>& side,
                     F&& f) const;
  /// Normals, gaps and frictions of the pairs at a node whose sides are known.
  void find_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<double>& stiffness, const ContactSettings& settings,
                  const ContactNode& node);
  /// A rigid body meets others with its whole mass, spread over its overlapped nodes; one whose
  /// motion is prescribed mostly with an infinite mass.
  void share_rigid_masses(const std::vector<Body<D>>& bodies);
  /// May any pair at a node act? Other nodes stay as they are, to the last bit.
  bool any_closed(const ContactNode& node) const;
  PairRecord& record_of(int a, int b);
  void enter(std::size_t record);
  void sort_records();

  std::vector<TileHolder> holders_;
  std::vector<ContactTile<D>> tiles_;
  static_assert(Tile<D>::cell_count <= 64);
  struct TileCounts {
    std::uint32_t nodes, sides, pairs;
    std::uint64_t overlapped;  // the tile's overlapped nodes, a bit each, by Tile<D>::cell
  };
  std::vector<TileCounts> counts_;  // per tile, from the second entry on; then their running sums
  std::vector<ContactNode> nodes_;
  std::vector<Side<D>> sides_;
  std::vector<SidePair<D>> pairs_;
  std::vector<double> rigid_share_;  // scratch
  std::vector<PairRecord> records_;  // sorted by (a, b) between steps
  // Where a pair's record is: open addressing by pair_key, at most half full; 0 is empty, else the
  // record's number + 1.
  std::vector<std::uint32_t> places_;
  std::size_t nodes_max_ = 0;
  int bodies_max_ = 0;
  std::atomic<std::size_t> unconverged_{0};
};

template <int D>
template <class F>
void ContactGrid<D>::for_each_copy(const TileGrid<D>& grid, const ContactNode& node,
                                   const Side<D>& side, F&& f) const {
  const Index<D> index = Tile<D>::cell_index(node.cell);
  for (std::uint32_t h = side.first_copy; h < side.first_copy + side.copies; ++h)
    if (holds_node<D>(grid.shape, holders_[h], index))
      f(static_cast<std::size_t>(holders_[h].patch),
        node_in_holder<D>(grid.shape, holders_[h], index));
}

}  // namespace mpm
