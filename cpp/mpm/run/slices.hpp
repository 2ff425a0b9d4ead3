#pragma once
// Rows in the user's order, of which some ranks get a slice each: those that write them.
#include <vector>

#include "mpm/comm/share.hpp"

namespace mpm {

/// Equal slices of so many rows, the first one for the first of these ranks.
class Slices {
 public:
  /// All for rank 0.
  explicit Slices(std::size_t rows) : Slices(rows, {0}) {}
  /// Throws std::invalid_argument if there are no ranks, or they do not rise.
  Slices(std::size_t rows, std::vector<int> ranks);

  std::size_t size() const { return ranks_.size(); }
  int rank(std::size_t slice) const { return ranks_[slice]; }
  Share rows(std::size_t slice) const { return {rows_, slice, ranks_.size()}; }
  /// The one of a rank: without rows if it gets none.
  Share of(int rank) const;
  /// That has the row.
  std::size_t slice_with(std::size_t row) const;

 private:
  std::size_t rows_;
  std::vector<int> ranks_;
};

}  // namespace mpm
