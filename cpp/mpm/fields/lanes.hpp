#pragma once
// Rows of a column into SIMD lanes and back, through an index: neighbours in memory move as one
// vector, others one by one.
#include <cstdint>

#include "mpm/math/scalar.hpp"

namespace mpm {

/// Up to W rows of a column. Lanes from `count` on repeat the last row when read and are never
/// written.
template <int W>
struct LaneRows {
  std::uint32_t row[W];
  int count;
  bool contiguous;  // the rows are in sequence

  LaneRows(const std::uint32_t* rows, std::size_t available) {
    count = available < W ? static_cast<int>(available) : W;
    for (int k = 0; k < W; ++k) row[k] = rows[k < count ? k : count - 1];
    contiguous = true;
    for (int k = 1; k < W; ++k)
      contiguous = contiguous && (k >= count || row[k] == row[0] + static_cast<std::uint32_t>(k));
  }
};

/// Columns have room for W rows behind their last (Columns).
template <int W>
Batch<W> load(const double* column, const LaneRows<W>& rows) {
  if (rows.contiguous) {
    const auto b = Batch<W>::load(column + rows.row[0]);
    return rows.count == W
               ? b
               : select(first_lanes<W>(rows.count), b, Batch<W>(column[rows.row[W - 1]]));
  }
  Batch<W> b;
  for (int k = 0; k < W; ++k) b.v[k] = column[rows.row[k]];
  return b;
}

inline double load(const double* column, const LaneRows<1>& rows) { return column[rows.row[0]]; }

template <int W>
void store(double* column, const LaneRows<W>& rows, Batch<W> value) {
  if (rows.contiguous && rows.count == W) {
    value.store(column + rows.row[0]);
    return;
  }
  for (int k = 0; k < rows.count; ++k) column[rows.row[k]] = value.v[k];
}

inline void store(double* column, const LaneRows<1>& rows, double value) {
  column[rows.row[0]] = value;
}

/// Lanes from and to memory in sequence, and those before `count`, for a number or a Batch.
template <class T>
T load_lanes(const double* from) {
  if constexpr (std::is_same_v<T, double>)
    return *from;
  else
    return T::load(from);
}
inline void store_lanes(double* to, double value) { *to = value; }
template <int W>
void store_lanes(double* to, Batch<W> value) {
  value.store(to);
}
template <class T>
Truth<T> lanes_before(int count) {
  if constexpr (std::is_same_v<T, double>)
    return count > 0;
  else
    return first_lanes<T::lanes>(count);
}

}  // namespace mpm
