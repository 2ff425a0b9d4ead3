#pragma once
// What has passed between pairs of bodies since the start.
#include <cstdint>
#include <limits>
#include <vector>

#include "mpm/fields/state_stream.hpp"

namespace mpm {

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

/// The records of all pairs that have met, found by the numbers of the bodies.
class PairRecords {
 public:
  /// Sorted by (a, b) between steps.
  const std::vector<PairRecord>& all() const { return records_; }
  std::size_t size() const { return records_.size(); }
  /// Forces are those of one step.
  void clear_forces();
  /// The record of a pair, a < b; a new one stands at the end until sort().
  PairRecord& of(int a, int b);
  /// Put new records in their order among the old ones.
  void sort();

  /// Save or restore them. Throws std::invalid_argument for records of other bodies.
  void exchange(StateStream& stream);
  void check_restored(std::size_t bodies);
  std::size_t bytes() const;

 private:
  void enter(std::size_t record);

  std::vector<PairRecord> records_;
  // Where a pair's record is: open addressing by pair_key, at most half full; 0 is empty, else the
  // record's number + 1.
  std::vector<std::uint32_t> places_;
};

}  // namespace mpm
