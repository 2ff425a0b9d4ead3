#pragma once
// Structure of arrays: named columns of doubles, each of one or more components; a column exists
// only if it was asked for.
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mpm/fields/aligned.hpp"

namespace mpm {

struct ColumnInfo {
  std::string name;
  std::string unit;
  int components = 1;
  int first = 0;  // index of its first component among all components
};

/// All columns of one body, in one allocation: component c of row i is `component(c)[i]`.
class Columns {
 public:
  /// Declare a column before `allocate`; returns the index of its first component. Throws
  /// std::invalid_argument for a name that is taken.
  int add(std::string name, std::string unit, int components) {
    for (const auto& i : infos_)
      if (i.name == name) throw std::invalid_argument("two columns are named " + name);
    const int first = component_count();
    infos_.push_back({std::move(name), std::move(unit), components, first});
    return first;
  }

  void allocate(std::size_t rows) {
    rows_ = rows;
    stride_ = padded(rows);
    memory_.release_and_allocate(static_cast<std::size_t>(component_count()) * stride_);
  }

  std::size_t rows() const { return rows_; }
  std::size_t stride() const { return stride_; }  // from one component to the next
  std::size_t bytes() const { return memory_.bytes(); }
  const std::vector<ColumnInfo>& infos() const { return infos_; }
  double* component(int c) { return memory_.data() + static_cast<std::size_t>(c) * stride_; }
  const double* component(int c) const {
    return memory_.data() + static_cast<std::size_t>(c) * stride_;
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
  // At least eight rows more, so that whole vectors may be read at the end. Columns a multiple of
  // 4096 bytes apart would all fall into the same cache sets: stagger them by three lines. Whole
  // pages between them would double the memory of small bodies, which stay off such multiples
  // instead.
  static std::size_t padded(std::size_t rows) {
    constexpr std::size_t page = 4096 / sizeof(double), stagger = 3 * cache_line / sizeof(double);
    const std::size_t lines = (rows + 15) / 8 * 8, beyond = lines % page;
    if (lines < page) return lines;
    if (lines < 16 * page) return beyond < stagger ? lines + stagger - beyond : lines;
    return (lines - stagger + page - 1) / page * page + stagger;
  }

  std::vector<ColumnInfo> infos_;
  AlignedArray<double> memory_;
  std::size_t rows_ = 0, stride_ = 0;
};

}  // namespace mpm
