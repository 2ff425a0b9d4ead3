#pragma once
// What has passed between pairs of bodies since the start.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/state/state_stream.hpp"

namespace mpm {

/// What is said of a checkpoint whose contacts make no sense.
inline constexpr const char* damaged_contacts = "its contacts are damaged";

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

/// What passes between two bodies at some nodes in a step, in the units of PairRecords.
struct PairShare {
  int a, b;    // a < b
  bool known;  // they have met in an earlier step
  FixedSum::Integer impulse[3] = {}, friction_work = 0;
  // Of the node of those at which the lighter body has most mass [m].
  double share = 0.0;  // that mass over a particle's
  double gap = 0.0, normal[3] = {}, node[3] = {};
};

/// Which of two nodes tells of a first contact, if all else is equal: so that it is the same one in
/// any order.
inline bool is_lower(const double (&x)[3], const double (&y)[3]) {
  return std::lexicographical_compare(std::rbegin(x), std::rend(x), std::rbegin(y), std::rend(y));
}

/// The records of all pairs that have met, found by the numbers of the bodies.
class PairRecords {
 public:
  /// Sorted by (a, b) between steps.
  const std::vector<PairRecord>& all() const { return records_; }
  /// The same with what the others have recorded; by all ranks at once.
  std::vector<PairRecord> of_all_ranks(Comm& comm) const { return with_others(comm).records_; }
  std::size_t size() const { return records_.size(); }
  /// Before the first step: about the largest mass [kg] and speed [m/s] that there are. Sums are
  /// good to 2^-96 of their product, and hold up to 2^31 of it.
  void set_scale(double mass, double speed);
  /// Forces are those of one step.
  void begin_step();
  /// Whether a pair, a < b, met in a step before this one.
  bool known(int a, int b, std::int64_t step) const;
  /// Add to a share an impulse on a [N s], zeros behind the dimension, and the work of friction
  /// [J].
  void add_to(PairShare& share, const double (&impulse)[3], double friction_work) const;
  /// Add a share to its record. A new record stands at the end until end_step().
  void add(const PairShare& share, std::int64_t step, double time);
  /// Write the sums into the records, and put new ones in their order among the old ones.
  void end_step(double time_step);

  /// Save or restore those of all ranks.
  void exchange(StateStream& stream);
  /// Throws std::invalid_argument for records of other bodies. One rank keeps those that were
  /// restored, and others none.
  void check_restored(std::size_t bodies, bool keep);
  std::size_t bytes() const;

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t find(int a, int b) const;  // the number of the record of a pair, or none
  std::size_t make(int a, int b);
  void enter(std::size_t record);
  PairRecords with_others(Comm& comm) const;
  void exchange_own(StateStream& stream);
  void sort();
  void write_sums(std::size_t record);

  std::vector<PairRecord> records_;
  std::vector<PairSums> sums_;  // of each record
  std::size_t sorted_ = 0;      // records
  SumUnit impulse_unit_{-96}, energy_unit_{-96};
  double time_step_ = 0.0;  // of the last step [s]
  // Where a pair's record is: open addressing by pair_key, at most half full; 0 is empty, else the
  // record's number + 1.
  std::vector<std::uint32_t> places_;
};

}  // namespace mpm
