#pragma once
// Structure of arrays: named columns of numbers, each of one or more components; a column exists
// only if it was asked for.
#include <algorithm>
#include <cassert>
#include <concepts>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mpm/fields/memory_space.hpp"

namespace mpm {

/// What velocities and stresses are rounded to where they are kept; a step changes other columns by
/// small parts of themselves. All arithmetic is that of doubles.
#if defined(MPM_FLOAT32)
using Storage = float;
#else
using Storage = double;
#endif

enum class Precision { exact, rounded };

struct ColumnInfo {
  std::string name;
  std::string unit;
  int components = 1;
  int first = 0;  // index of its first component among all components
  Precision kept = Precision::exact;

  std::size_t number_bytes() const {
    return kept == Precision::exact ? sizeof(double) : sizeof(Storage);
  }
};

/// Numbers from one component to the next for so many rows: at least eight rows more, so that whole
/// vectors may be read at the end. Columns a multiple of 4096 bytes apart would all fall into the
/// same cache sets: stagger them by three lines. Whole pages between them would double the memory
/// of small bodies, which stay off such multiples instead.
inline std::size_t padded(std::size_t rows) {
  constexpr std::size_t line = cache_line / sizeof(Storage), page = 4096 / sizeof(double),
                        stagger = 3 * line;  // in numbers; pages of doubles, halves of floats'
  const std::size_t lines = (rows + 7 + line) / line * line, beyond = lines % page;
  if (lines < page) return lines;
  if (lines < 16 * page) return beyond < stagger ? lines + stagger - beyond : lines;
  return (lines - stagger + page - 1) / page * page + stagger;
}

/// Columns of so many rows each, in one allocation in a memory space: component c of row i is
/// `component(c)[i]`, or `rounded(c)[i]` if the column is kept so.
template <MemorySpace Space>
class ColumnsIn {
 public:
  /// Declare a column before `allocate`; returns the index of its first component. Throws
  /// std::invalid_argument for a name that is taken.
  int add(std::string name, std::string unit, int components, Precision kept = Precision::exact) {
    for (const auto& i : infos_)
      if (i.name == name) throw std::invalid_argument("two columns are named " + name);
    const int first = component_count();
    infos_.push_back({std::move(name), std::move(unit), components, first, kept});
    return first;
  }

  void allocate(std::size_t rows) {
    rows_ = rows;
    stride_ = padded(rows);
    begin_.clear();
    std::size_t bytes = 0;
    for (const ColumnInfo& info : infos_)
      for (int c = 0; c < info.components; ++c) {
        begin_.push_back(bytes);
        bytes += stride_ * info.number_bytes();
      }
    memory_.release_and_allocate(bytes);
  }

  /// Columns with the same names and rows in this space, of those in the host's memory.
  void copy_from_host(const ColumnsIn<HostSpace>& host)
    requires(!std::same_as<Space, HostSpace>)
  {
    infos_ = host.infos_;
    allocate(host.rows_);
    Space::from_host(memory_.data(), host.memory_.data(), memory_.bytes());
  }
  /// The rows back into the columns that they came from.
  void copy_to_host(ColumnsIn<HostSpace>& host) const
    requires(!std::same_as<Space, HostSpace>)
  {
    assert(host.rows_ == rows_ && host.begin_ == begin_);
    Space::to_host(host.memory_.data(), memory_.data(), memory_.bytes());
  }

  std::size_t rows() const { return rows_; }
  std::size_t stride() const { return stride_; }  // numbers from one component to the next
  std::size_t bytes() const { return memory_.bytes(); }
  const std::vector<ColumnInfo>& infos() const { return infos_; }
  double* component(int c) { return reinterpret_cast<double*>(begin_of(c, Precision::exact)); }
  const double* component(int c) const {
    return reinterpret_cast<const double*>(begin_of(c, Precision::exact));
  }
  Storage* rounded(int c) { return reinterpret_cast<Storage*>(begin_of(c, Precision::rounded)); }
  const Storage* rounded(int c) const {
    return reinterpret_cast<const Storage*>(begin_of(c, Precision::rounded));
  }
  /// f(component c), whichever way its column is kept.
  template <class F>
  void with_component(int c, F&& f) {
    info_of(c).kept == Precision::exact ? f(component(c)) : f(rounded(c));
  }
  template <class F>
  void with_component(int c, F&& f) const {
    info_of(c).kept == Precision::exact ? f(component(c)) : f(rounded(c));
  }
  double value(int c, std::size_t row) const {
    return info_of(c).kept == Precision::exact ? component(c)[row] : double{rounded(c)[row]};
  }

  /// The column's description; throws std::invalid_argument for an unknown name, with those that
  /// there are.
  const ColumnInfo& info(std::string_view name) const {
    for (const auto& i : infos_)
      if (i.name == name) return i;
    std::string known;
    for (const auto& i : infos_) known += (known.empty() ? "" : ", ") + i.name;
    throw std::invalid_argument("no column is named " + std::string(name) + "; there are " + known);
  }

  int component_count() const {
    return infos_.empty() ? 0 : infos_.back().first + infos_.back().components;
  }

 private:
  template <MemorySpace>
  friend class ColumnsIn;
  template <class Copy>
  friend void reallocate(ColumnsIn<HostSpace>& columns, std::size_t rows, Copy&& copy);

  const ColumnInfo& info_of(int c) const {
    std::size_t k = infos_.size();
    while (infos_[--k].first > c) {
    }
    return infos_[k];
  }
  const std::byte* begin_of(int c, [[maybe_unused]] Precision kept) const {
    assert(info_of(c).kept == kept);
    return memory_.data() + begin_[static_cast<std::size_t>(c)];
  }
  std::byte* begin_of(int c, Precision kept) {
    return const_cast<std::byte*>(std::as_const(*this).begin_of(c, kept));
  }

  std::vector<ColumnInfo> infos_;
  std::vector<std::size_t> begin_;  // of each component, in bytes
  AlignedArray<std::byte, Space> memory_;
  std::size_t rows_ = 0, stride_ = 0;
};

using Columns = ColumnsIn<HostSpace>;

/// Columns anew, with so many rows; copy(from, to) for the numbers of each component before and
/// now.
template <class Copy>
void reallocate(Columns& columns, std::size_t rows, Copy&& copy) {
  const std::vector<std::size_t> from = columns.begin_;
  const AlignedArray<std::byte> before = std::move(columns.memory_);
  columns.allocate(rows);
  std::size_t k = 0;
  for (const ColumnInfo& info : columns.infos_)
    for (int c = 0; c < info.components; ++c, ++k) {
      const std::byte* const old = before.data() + from[k];
      std::byte* const now = columns.memory_.data() + columns.begin_[k];
      if (info.kept == Precision::exact)
        copy(reinterpret_cast<const double*>(old), reinterpret_cast<double*>(now));
      else
        copy(reinterpret_cast<const Storage*>(old), reinterpret_cast<Storage*>(now));
    }
}

/// More rows behind those that there are, which keep what they hold.
inline void grow(Columns& columns, std::size_t rows) {
  const std::size_t kept = columns.rows();
  reallocate(columns, rows, [&](const auto* from, auto* to) { std::copy_n(from, kept, to); });
}

/// The given rows in their order, and room behind them for `room` in all.
inline void repack(Columns& columns, std::span<const std::uint32_t> rows, std::size_t room) {
  reallocate(columns, room, [&](const auto* from, auto* to) {
    for (const std::uint32_t row : rows) *to++ = from[row];
  });
}

}  // namespace mpm
