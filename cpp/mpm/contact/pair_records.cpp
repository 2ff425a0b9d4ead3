#include "mpm/contact/pair_records.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "mpm/contact/settings.hpp"
#include "mpm/fields/lists.hpp"

namespace mpm {
namespace {

constexpr double least_share =
    1e-6;  // of a particle's mass, for a node to count as a first contact

/// Spread the pairs of bodies over all numbers (Fibonacci hashing, Knuth 1973, section 6.4).
std::size_t hash(int a, int b) {
  const std::uint64_t product = pair_key(a, b) * 0x9E3779B97F4A7C15u;
  return static_cast<std::size_t>(product >> 32);
}

/// Let a record tell of the contact of another, if that was earlier, or at once with more mass or
/// lower.
void take_first_contact(const PairRecord& from, PairRecord& to) {
  const auto in_order = [](const PairRecord& x) { return std::pair(x.first_step, -x.first_share); };
  if (from.first_step < 0) return;
  if (to.first_step >= 0) {
    if (in_order(to) < in_order(from)) return;
    if (in_order(to) == in_order(from) && !is_lower(from.first_node, to.first_node)) return;
  }
  to.first_step = from.first_step;
  to.first_time = from.first_time;
  to.first_gap = from.first_gap;
  to.first_share = from.first_share;
  std::ranges::copy(from.first_normal, to.first_normal);
  std::ranges::copy(from.first_node, to.first_node);
}

}  // namespace

std::size_t PairRecords::find(int a, int b) const {
  if (places_.empty()) return none;
  const std::size_t mask = places_.size() - 1;
  // Ends at an empty place: at most half of them are taken.
  for (std::size_t at = hash(a, b) & mask; places_[at] != 0; at = (at + 1) & mask) {
    const PairRecord& record = records_[places_[at] - 1];
    if (record.a == a && record.b == b) return places_[at] - 1;
  }
  return none;
}

bool PairRecords::known(int a, int b, std::int64_t step) const {
  const std::size_t record = find(a, b);
  return record != none && records_[record].first_step >= 0 && records_[record].first_step < step;
}

std::size_t PairRecords::make(int a, int b) {
  PairRecord record;
  record.a = a;
  record.b = b;
  record.pairs = 1;
  records_.push_back(record);
  sums_.emplace_back();
  if (2 * records_.size() > places_.size()) {
    places_.assign(std::max<std::size_t>(64, 4 * places_.size()), 0);
    for (std::size_t k = 0; k < records_.size(); ++k) enter(k);
  } else {
    enter(records_.size() - 1);
  }
  return records_.size() - 1;
}

/// Note where a record is.
void PairRecords::enter(std::size_t record) {
  const std::size_t mask = places_.size() - 1;
  std::size_t at = hash(records_[record].a, records_[record].b) & mask;
  while (places_[at] != 0) at = (at + 1) & mask;
  places_[at] = static_cast<std::uint32_t>(record) + 1;
}

void PairRecords::sort() {
  std::vector<std::size_t> order(records_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {},
                    [&](std::size_t k) { return std::pair(records_[k].a, records_[k].b); });
  const auto reorder = [&](auto& values) {
    auto sorted = values;
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
    std::ranges::copy(sorted, values.begin());
  };
  // Only in steps with new pairs: between steps records are in the order of (a, b), whenever pairs
  // met.
  reorder(records_);
  reorder(sums_);
  std::fill(places_.begin(), places_.end(), 0u);
  for (std::size_t k = 0; k < records_.size(); ++k) enter(k);
  sorted_ = records_.size();
}

void PairRecords::set_scale(double mass, double speed) {
  // 127 bits less 96 leave sums of up to 2^31 of the scale (decision 0038).
  constexpr int digits = 96;
  impulse_unit_ = SumUnit(std::ilogb(mass * speed) - digits);
  energy_unit_ = SumUnit(std::ilogb(mass * speed * speed) - digits);
}

void PairRecords::begin_step() {
  for (PairSums& sums : sums_)
    for (FixedSum& impulse : sums.step_impulse) impulse.clear();
}

void PairRecords::add_to(PairShare& share, const double (&impulse)[3], double friction_work) const {
  for (std::size_t a = 0; a < 3; ++a)
    share.impulse[a] += FixedSum::in_units(impulse[a], impulse_unit_);
  share.friction_work += FixedSum::in_units(friction_work, energy_unit_);
}

void PairRecords::add(const PairShare& share, std::int64_t step, double time) {
  std::size_t record = find(share.a, share.b);
  if (record == none) record = make(share.a, share.b);
  PairSums& sums = sums_[record];
  for (std::size_t a = 0; a < 3; ++a) {
    sums.step_impulse[a].add(share.impulse[a]);
    sums.impulse[a].add(share.impulse[a]);
  }
  sums.friction_work.add(share.friction_work);
  PairRecord& r = records_[record];
  // A node that a body has only just reached tells nothing about when and where they met.
  if (share.known || !(share.share > least_share)) return;
  PairRecord met;
  met.first_step = step;
  met.first_time = time;
  met.first_gap = share.gap;
  met.first_share = share.share;
  std::ranges::copy(share.normal, met.first_normal);
  std::ranges::copy(share.node, met.first_node);
  take_first_contact(met, r);
}

/// From the sums to the record.
void PairRecords::write_sums(std::size_t record) {
  PairRecord& r = records_[record];
  for (std::size_t a = 0; a < 3; ++a) {
    r.force[a] = sums_[record].step_impulse[a].value(impulse_unit_) / time_step_;
    r.impulse[a] = sums_[record].impulse[a].value(impulse_unit_);
  }
  r.friction_work = sums_[record].friction_work.value(energy_unit_);
}

void PairRecords::end_step(double time_step) {
  time_step_ = time_step;
  for (std::size_t k = 0; k < records_.size(); ++k) write_sums(k);
  if (records_.size() > sorted_) sort();
}

PairRecords PairRecords::with_others(Comm& comm) const {
  if (comm.alone()) return *this;
  Mail mail;
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank == comm.rank()) continue;
    Letter& letter = letter_to(mail, rank);
    for (std::size_t k = 0; k < records_.size(); ++k) {
      mpm::write(letter, records_[k]);
      mpm::write(letter, sums_[k]);
    }
  }
  comm.exchange(mail);
  PairRecords all = *this;
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      const auto told = reader.read<PairRecord>();
      const auto sums = reader.read<PairSums>();
      std::size_t record = all.find(told.a, told.b);
      if (record == none) record = all.make(told.a, told.b);
      for (std::size_t a = 0; a < 3; ++a) {
        all.sums_[record].step_impulse[a].add(sums.step_impulse[a]);
        all.sums_[record].impulse[a].add(sums.impulse[a]);
      }
      all.sums_[record].friction_work.add(sums.friction_work);
      take_first_contact(told, all.records_[record]);
    }
  for (std::size_t k = 0; k < all.records_.size(); ++k) all.write_sums(k);
  all.sort();
  return all;
}

void PairRecords::exchange(StateStream& stream) {
  if (!stream.restores() && !stream.comm().alone()) {
    with_others(stream.comm()).exchange_own(stream);
    return;
  }
  exchange_own(stream);
}

void PairRecords::exchange_own(StateStream& stream) {
  stream.vector(records_);
  stream.vector(sums_);
  stream(time_step_);
}

void PairRecords::check_restored(std::size_t bodies, bool keep) {
  const auto is_body = [&](int b) { return b >= 0 && static_cast<std::size_t>(b) < bodies; };
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const PairRecord& r = records_[k];
    const bool later =
        k == 0 || std::pair(records_[k - 1].a, records_[k - 1].b) < std::pair(r.a, r.b);
    StateStream::check(is_body(r.a) && is_body(r.b) && r.a < r.b && later, damaged_contacts);
  }
  StateStream::check(sums_.size() == records_.size(), damaged_contacts);
  if (!keep) {
    records_.clear();
    sums_.clear();
  }
  // Half of the places at most are taken.
  places_.assign(std::bit_ceil(std::max<std::size_t>(64, 2 * records_.size())), 0);
  sort();
}

std::size_t PairRecords::bytes() const {
  return bytes_of(records_) + bytes_of(sums_) + bytes_of(places_);
}

}  // namespace mpm
