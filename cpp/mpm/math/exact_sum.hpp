#pragma once
// Sums that depend on no order: integers, rounded once at the end.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace mpm {

/// The sum of any doubles, exact, in integers 32 bits apart (the small superaccumulator of Neal
/// 2015, section 3). An addition takes some 5 ns.
class ExactSum {
 public:
  void add(double x) {
    if (!std::isfinite(x)) {
      special_ += x;  // infinite or no number, and so is the sum
      return;
    }
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const auto exponent = static_cast<int>(bits >> 52 & 0x7ff);
    std::uint64_t mantissa = bits & 0xfffffffffffffu;
    if (exponent != 0) mantissa |= std::uint64_t{1} << 52;
    // Numbers below 2^-1022 have no leading one and the same lowest bit as those with exponent 1.
    const int shift = exponent == 0 ? 0 : exponent - 1;  // of the lowest bit, from 2^-1074
    const auto chunk = static_cast<std::size_t>(shift / 32);
    const int within = shift % 32;
    // The mantissa has up to 53 + 31 bits from here, three chunks; what the first shift drops is in
    // `high`.
    const std::uint64_t low = mantissa << within & 0xffffffffu;
    const std::uint64_t high = mantissa >> (32 - within);  // below 2^52
    const std::int64_t sign = std::signbit(x) ? -1 : 1;
    // Chunk + 3, one more than written: it takes the carry and the sign.
    first_ = std::min(first_, chunk);
    top_ = std::max(top_, chunk + 3);
    chunks_[chunk] += sign * static_cast<std::int64_t>(low);
    chunks_[chunk + 1] += sign * static_cast<std::int64_t>(high & 0xffffffffu);
    chunks_[chunk + 2] += sign * static_cast<std::int64_t>(high >> 32);
    // Carries wait: an addition is three sums of integers without a branch on what is there.
    if (++additions_ == most_additions) carry();
  }
  void add(const ExactSum& other) {
    special_ += other.special_;
    // Both carried first: what two chunks below 2^32 add up to leaves room for 2^29 additions more.
    ExactSum carried = other;
    carried.carry();
    carry();
    first_ = std::min(first_, other.first_);
    top_ = std::max(top_, other.top_);
    for (std::size_t k = 0; k < count; ++k) chunks_[k] += carried.chunks_[k];
  }

  /// The sum in integers, alike for equal sums. Those of several sums, each added up, can be read
  /// as the sum of all.
  static constexpr std::size_t words = 71;
  void write(std::span<std::int64_t, words> to) const {
    ExactSum carried = *this;
    carried.top_ = count - 1;
    carried.carry();
    std::ranges::copy(carried.chunks_, to.begin());
    to[count] = std::isnan(special_) ? 1 : 0;
    to[count + 1] = special_ == HUGE_VAL ? 1 : 0;
    to[count + 2] = special_ == -HUGE_VAL ? 1 : 0;
  }
  static ExactSum read(std::span<const std::int64_t, words> from) {
    ExactSum sum;
    std::copy_n(from.begin(), count, sum.chunks_.begin());
    sum.first_ = 0;
    sum.top_ = count - 1;
    const bool none = from[count] > 0 || (from[count + 1] > 0 && from[count + 2] > 0);
    if (none)
      sum.special_ = std::nan("");
    else if (from[count + 1] + from[count + 2] > 0)
      sum.special_ = from[count + 1] > 0 ? HUGE_VAL : -HUGE_VAL;
    return sum;
  }

  /// The double nearest to the sum; of two the even one.
  double value() const {
    if (special_ != 0.0) return special_;
    ExactSum sum = *this;
    sum.carry();
    const bool negative = sum.chunks_[top_] < 0;
    // To sign and size: rounding to the nearest even is alike on both sides of zero.
    if (negative) {
      for (std::size_t k = first_; k <= top_; ++k) sum.chunks_[k] = -sum.chunks_[k];
      sum.carry();
    }
    std::size_t top = top_ + 1;
    while (top > 0 && sum.chunks_[top - 1] == 0) --top;
    if (top == 0) return 0.0;
    // The highest 64 bits, the last of them set if any lower one is: enough to round rightly.
    const auto at = [&](std::size_t k) { return static_cast<std::uint64_t>(sum.chunks_[k]); };
    const int lead = std::countl_zero(static_cast<std::uint32_t>(at(top - 1)));
    const std::uint64_t second = top >= 2 ? at(top - 2) : 0, third = top >= 3 ? at(top - 3) : 0;
    // A conversion of 64 bits rounds to the nearest even one at bit 11; with the lowest bit set for
    // all that is behind, a tie is seen as none where it is none.
    std::uint64_t bits = at(top - 1) << 32 | second;
    bool more = false;
    if (lead > 0) {
      bits = bits << lead | third >> (32 - lead);
      more = (third << lead & 0xffffffffu) != 0;
    } else {
      more = third != 0;
    }
    for (std::size_t k = first_; k + 3 < top && !more; ++k) more = sum.chunks_[k] != 0;
    if (more) bits |= 1;
    const int exponent = 32 * (static_cast<int>(top) - 2) - lead - 1074;
    // No second rounding: all sums are multiples of 2^-1074, so one below 2^-1022 has fewer than 53
    // bits, and is exact before and after.
    const double size = std::ldexp(static_cast<double>(bits), exponent);
    return negative ? -size : size;
  }

 private:
  // Doubles have bits from 2^-1074 to 2^1023, 2098 in all or 66 chunks; above them is room for
  // carries.
  static constexpr std::size_t count = 68;
  static constexpr int most_additions = 1 << 29;  // of 32 bits each to 63

  /// Bring all but the highest, which has the sign, below 2^32, and to no less than 0.
  void carry() {
    for (std::size_t k = first_; k < top_; ++k) {
      const std::int64_t over = chunks_[k] >> 32;  // rounded down
      chunks_[k] -= over * (std::int64_t{1} << 32);
      chunks_[k + 1] += over;
    }
    additions_ = 0;
  }

  std::array<std::int64_t, count> chunks_{};
  std::size_t first_ = count, top_ = 0;  // those that are not 0 lie between
  double special_ = 0.0;
  int additions_ = 0;
};

/// A power of two, in whole multiples of which values are summed.
class SumUnit {
 public:
  explicit SumUnit(int exponent)
      : size_(std::ldexp(1.0, bounded(exponent))), per_unit_(std::ldexp(1.0, -bounded(exponent))) {}
  double size() const { return size_; }
  double per_unit() const { return per_unit_; }

 private:
  // So that neither the unit nor its inverse leaves the range of doubles.
  static constexpr int bounded(int exponent) { return std::clamp(exponent, -1000, 1000); }
  double size_, per_unit_;
};

/// The sum of values rounded to whole multiples of a unit: 16 bytes, for sums of which there are
/// many. The unit must be the same for all that are compared; sums of up to 2^127 units fit.
class FixedSum {
 public:
  __extension__ typedef __int128 Integer;

  /// A value in units.
  static Integer in_units(double x, const SumUnit& unit) {
    // Exact, for the unit is a power of two, and what underflows is far below one unit; a product
    // takes less time than ldexp (decision 0038).
    const double units = x * unit.per_unit();
    // In two parts, as a double has 53 bits and the sum 127.
    const double high = std::trunc(units * 0x1p-64);
    const double low = std::nearbyint(units - high * 0x1p64);
    return static_cast<Integer>(high) * (Integer{1} << 64) + static_cast<Integer>(low);
  }
  void add(double x, const SumUnit& unit) { sum_ += in_units(x, unit); }
  void add(Integer units) { sum_ += units; }
  void add(const FixedSum& other) { sum_ += other.sum_; }
  double value(const SumUnit& unit) const { return static_cast<double>(sum_) * unit.size(); }
  void clear() { sum_ = 0; }

 private:
  Integer sum_ = 0;
};

}  // namespace mpm
