#include "mpm/run/slices.hpp"

#include <algorithm>
#include <stdexcept>

namespace mpm {

Slices::Slices(std::size_t rows, std::vector<int> ranks) : rows_(rows), ranks_(std::move(ranks)) {
  if (ranks_.empty() || ranks_.front() < 0 ||
      std::ranges::adjacent_find(ranks_, std::greater_equal{}) != ranks_.end())
    throw std::invalid_argument("ranks that get rows must be numbers that rise");
}

Share Slices::of(int rank) const {
  const auto found = std::ranges::find(ranks_, rank);
  if (found == ranks_.end()) return {};
  return rows(static_cast<std::size_t>(found - ranks_.begin()));
}

std::size_t Slices::slice_with(std::size_t row) const {
  std::size_t slice = row * size() / rows_;  // It, or by rounding the one before.
  while (row >= rows(slice).last) ++slice;
  return slice;
}

}  // namespace mpm
