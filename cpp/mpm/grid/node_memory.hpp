#pragma once
// The memory of the nodes: the blocks of all patches, one behind another.
#include <cstddef>
#include <cstdint>
#include <span>

#include "mpm/fields/memory_space.hpp"
#include "mpm/layout/node_records.hpp"

namespace mpm {

struct NodeMemory {
  AlignedArray<double> numbers;
  std::size_t needed = 0;  // of them, by the blocks that are cut

  /// A node's record as a number, for those who come back to it before blocks are cut anew.
  std::uint32_t index_of(const double* node) const {
    return static_cast<std::uint32_t>((node - numbers.data()) / record);
  }
  double* record_at(std::uint32_t index) { return numbers.data() + std::size_t{index} * record; }
  /// All of it, for others until momentum is mapped. All values in it are lost.
  std::span<std::byte> idle() {
    return std::as_writable_bytes(std::span(numbers.data(), numbers.size()));
  }
};

}  // namespace mpm
