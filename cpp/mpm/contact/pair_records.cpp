#include "mpm/contact/pair_records.hpp"

#include <algorithm>
#include <bit>

#include "mpm/contact/settings.hpp"

namespace mpm {
namespace {

constexpr const char* damaged = "its contacts are damaged";

/// Spread the pairs of bodies over all numbers (Fibonacci hashing, Knuth 1973, section 6.4).
std::size_t hash(int a, int b) {
  const std::uint64_t product = pair_key(a, b) * 0x9E3779B97F4A7C15u;
  return static_cast<std::size_t>(product >> 32);
}

}  // namespace

PairRecord& PairRecords::of(int a, int b) {
  const std::size_t mask = places_.size() - 1;
  if (!places_.empty())
    for (std::size_t at = hash(a, b) & mask; places_[at] != 0; at = (at + 1) & mask) {
      PairRecord& record = records_[places_[at] - 1];
      if (record.a == a && record.b == b) return record;
    }
  PairRecord record;
  record.a = a;
  record.b = b;
  record.pairs = 1;
  records_.push_back(record);
  if (2 * records_.size() > places_.size()) {
    places_.assign(std::max<std::size_t>(64, 4 * places_.size()), 0);
    for (std::size_t k = 0; k < records_.size(); ++k) enter(k);
  } else {
    enter(records_.size() - 1);
  }
  return records_.back();
}

/// Note where a record is.
void PairRecords::enter(std::size_t record) {
  const std::size_t mask = places_.size() - 1;
  std::size_t at = hash(records_[record].a, records_[record].b) & mask;
  while (places_[at] != 0) at = (at + 1) & mask;
  places_[at] = static_cast<std::uint32_t>(record) + 1;
}

void PairRecords::sort() {
  std::sort(records_.begin(), records_.end(), [](const PairRecord& x, const PairRecord& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  std::fill(places_.begin(), places_.end(), 0u);
  for (std::size_t k = 0; k < records_.size(); ++k) enter(k);
}

void PairRecords::clear_forces() {
  for (PairRecord& r : records_) std::fill(std::begin(r.force), std::end(r.force), 0.0);
}

void PairRecords::exchange(StateStream& stream) {
  stream.vector(records_);
  stream.vector(places_);
}

void PairRecords::check_restored(std::size_t bodies) {
  const auto is_body = [&](int b) { return b >= 0 && static_cast<std::size_t>(b) < bodies; };
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const PairRecord& r = records_[k];
    const bool later =
        k == 0 || std::pair(records_[k - 1].a, records_[k - 1].b) < std::pair(r.a, r.b);
    StateStream::check(is_body(r.a) && is_body(r.b) && r.a < r.b && later, damaged);
  }
  StateStream::check(
      (places_.empty() && records_.empty()) ||
          (std::has_single_bit(places_.size()) && 2 * records_.size() <= places_.size()),
      damaged);
  sort();
}

std::size_t PairRecords::bytes() const {
  return records_.capacity() * sizeof(PairRecord) + places_.capacity() * sizeof(places_[0]);
}

}  // namespace mpm
