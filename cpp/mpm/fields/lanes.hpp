#pragma once
// Rows of a column into SIMD lanes and back, through an index: neighbours in memory move as one
// vector, others one by one.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "mpm/math/scalar.hpp"

namespace mpm {

#if !defined(__CUDACC__)
/// Lanes over the particles of a cell: no more than it holds if there are two along each axis.
template <int D>
inline constexpr int cell_lanes = std::min(native_lanes, 1 << D);

/// The same for a patch whose cells hold few: the other lanes of AVX-512 would stay empty, and half
/// a register costs half (Zen 4).
template <int D>
inline constexpr int few_lanes = cell_lanes<D> == 8 ? 4 : cell_lanes<D>;
#endif

/// Lanes over particles of which contact makes sums across the lanes: these decide normals and
/// gaps, so the width is the same whatever the instruction set.
inline constexpr int contact_lanes = 4;

/// Up to W rows of a column. Lanes from `count` on repeat the last row when read and are never
/// written.
template <int W>
struct LaneRows {
  static constexpr int lanes = W;
  std::uint32_t row[W];
  int count;
  bool contiguous;  // the rows are in sequence
  MPM_HD std::uint32_t operator[](int k) const { return row[k]; }

  MPM_HD LaneRows(const std::uint32_t* rows, std::size_t available) {
    count = available < W ? static_cast<int>(available) : W;
    if constexpr (W == 1) {
      // nvcc makes wrong code of std::copy_n here.
      row[0] = rows[0];
      contiguous = true;
      return;
    }
    if (count == W) {
      std::copy_n(rows, W, row);
      contiguous = in_sequence(rows);
      return;
    }
    std::uint32_t jumps = 0;
    for (int k = 0; k < W; ++k) {
      row[k] = rows[k < count ? k : count - 1];
      jumps |= k < count ? rows[k] - rows[0] - static_cast<std::uint32_t>(k) : 0;
    }
    contiguous = jumps == 0;
  }

 private:
  /// Two numbers at a time.
  MPM_HD static bool in_sequence(const std::uint32_t* rows) {
    const std::uint64_t first = rows[0], one_each = std::uint64_t{1} << 32 | 1;
    std::uint64_t expected = first | (first + 1) << 32, other = 0;
    for (int k = 0; k + 1 < W; k += 2, expected += 2 * one_each) {
      std::uint64_t pair;
      std::memcpy(&pair, rows + k, sizeof(pair));
      other |= pair ^ expected;
    }
    return other == 0;
  }
};

/// W rows in sequence.
template <int W>
struct WholeRows {
  static constexpr int lanes = W, count = W;
  std::uint32_t first;
  MPM_HD std::uint32_t operator[](int k) const { return first + static_cast<std::uint32_t>(k); }
};

/// f(rows) for rows of a list, W at a time; as WholeRows where they are, so that the loop over a
/// column that is in order is one of plain vectors.
template <int W, class F>
MPM_HD MPM_INLINE inline void for_each_lanes(const std::uint32_t* rows, std::uint32_t count,
                                             F&& f) {
  for (std::uint32_t k = 0; k < count; k += W) {
    const LaneRows<W> lanes(rows + k, count - k);
    if constexpr (W == 1)
      f(lanes);
    else if (lanes.contiguous && lanes.count == W)
      f(WholeRows<W>{lanes.row[0]});
    else
      f(lanes);
  }
}

/// A column is one of doubles or of floats.
template <class Number>
MPM_HD double load(const Number* column, const LaneRows<1>& rows) {
  return column[rows.row[0]];
}
template <class Number>
MPM_HD void store(Number* column, const LaneRows<1>& rows, double value) {
  column[rows.row[0]] = static_cast<Number>(value);
}

#if !defined(__CUDACC__)
template <class Number, int W>
Batch<W> load(const Number* column, const WholeRows<W>& rows) {
  return Batch<W>::load(column + rows.first);
}
template <class Number, int W>
void store(Number* column, const WholeRows<W>& rows, Batch<W> value) {
  value.store(column + rows.first);
}

template <class Number, int W>
Batch<W> load(const Number* column, const LaneRows<W>& rows) {
  if (rows.contiguous) {
    const Number* const first = column + rows.row[0];
    if (rows.count == W) return Batch<W>::load(first);
    if constexpr (std::is_same_v<Number, double>)
      return load_first<W>(first, rows.count, column[rows.row[W - 1]]);
  }
  Batch<W> b(0.0);
  for (int k = 0; k < W; ++k) b.v[k] = column[rows.row[k]];
  return b;
}

template <class Number, int W>
void store(Number* column, const LaneRows<W>& rows, Batch<W> value) {
  if (rows.contiguous && rows.count == W) {
    value.store(column + rows.row[0]);
    return;
  }
  for (int k = 0; k < W; ++k)
    if (k < rows.count) column[rows.row[k]] = static_cast<Number>(value.v[k]);
}

/// Zero in the lanes that repeat the last row.
template <int W>
Batch<W> of_valid(const LaneRows<W>& rows, Batch<W> value) {
  return select(first_lanes<W>(rows.count), value, Batch<W>(0.0));
}
template <int W>
Batch<W> of_valid(const WholeRows<W>&, Batch<W> value) {
  return value;
}
#endif

}  // namespace mpm
