#pragma once
// Many short lists in one piece of memory, and the memory that vectors take.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mpm {

template <class T, class Allocator>
std::size_t bytes_of(const std::vector<T, Allocator>& values) {
  return values.capacity() * sizeof(T);
}

/// Lists that are filled one after the other.
template <class T>
struct Lists {
  std::vector<T> all;
  std::vector<std::uint32_t> ends;  // of each, in `all`

  void end_list() { ends.push_back(static_cast<std::uint32_t>(all.size())); }
  std::size_t size() const { return ends.size(); }
  std::span<const T> operator[](std::size_t k) const {
    const std::size_t begin = k == 0 ? 0 : ends[k - 1];
    return {all.data() + begin, ends[k] - begin};
  }
  void shrink() {
    all.shrink_to_fit();
    ends.shrink_to_fit();
  }
  std::size_t bytes() const { return bytes_of(all) + bytes_of(ends); }
};

}  // namespace mpm
