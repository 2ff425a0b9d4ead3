#pragma once
// What has passed between pairs of bodies since the start.
#include <cstdint>
#include <limits>
#include <vector>

#include "mpm/fields/state_stream.hpp"
#include "mpm/math/exact_sum.hpp"

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

/// The sums from which a record has its numbers: they depend on no order of the nodes.
struct PairSums {
  FixedSum step_impulse[3], impulse[3], friction_work;
};

/// The records of all pairs that have met, found by the numbers of the bodies.
class PairRecords {
 public:
  /// Sorted by (a, b) between steps.
  const std::vector<PairRecord>& all() const { return records_; }
  std::size_t size() const { return records_.size(); }
  /// Before the first step: about the largest mass [kg] and speed [m/s] that there are. Sums are
  /// good to 2^-96 of their product, and hold up to 2^31 of it.
  void set_scale(double mass, double speed);
  /// Forces are those of one step.
  void begin_step();
  /// The number of the record of a pair, a < b; a new one stands at the end until end_step().
  std::size_t of(int a, int b);
  PairRecord& operator[](std::size_t record) { return records_[record]; }
  /// Add an impulse on a [N s], zeros behind the dimension, and the work of friction [J].
  void add(std::size_t record, const double (&impulse)[3], double friction_work);
  /// Write the sums into the records, and put new ones in their order among the old ones.
  void end_step(double time_step);

  /// Save or restore them. Throws std::invalid_argument for records of other bodies.
  void exchange(StateStream& stream);
  void check_restored(std::size_t bodies);
  std::size_t bytes() const;

 private:
  void enter(std::size_t record);
  void sort();

  std::vector<PairRecord> records_;
  std::vector<PairSums> sums_;                  // of each record
  std::size_t sorted_ = 0;                      // records
  int impulse_unit_ = -96, energy_unit_ = -96;  // exponents of powers of two
  // Where a pair's record is: open addressing by pair_key, at most half full; 0 is empty, else the
  // record's number + 1.
  std::vector<std::uint32_t> places_;
};

}  // namespace mpm
