#pragma once
// CUB's functions that the code for a device uses, on the processor.
#include <algorithm>
#include <cstddef>

namespace cub {

/// As CUB's, each asks for scratch first.
struct DeviceRadixSort {
  template <class T>
  static int SortKeys(void* scratch, std::size_t& bytes, const T* from, T* to, int count) {
    bytes = 1;
    if (scratch == nullptr) return 0;
    std::copy(from, from + count, to);
    std::sort(to, to + count);
    return 0;
  }
};
struct DeviceSelect {
  template <class T, class N>
  static int Unique(void* scratch, std::size_t& bytes, const T* from, T* to, N* found, int count) {
    bytes = 1;
    if (scratch == nullptr) return 0;
    *found = static_cast<N>(std::unique_copy(from, from + count, to) - to);
    return 0;
  }
};
struct DeviceScan {
  template <class T>
  static int ExclusiveSum(void* scratch, std::size_t& bytes, const T* from, T* to, int count) {
    bytes = 1;
    if (scratch == nullptr) return 0;
    T sum{};
    for (int k = 0; k < count; ++k) {
      const T next = from[k];
      to[k] = sum;
      sum += next;
    }
    return 0;
  }
};

}  // namespace cub
