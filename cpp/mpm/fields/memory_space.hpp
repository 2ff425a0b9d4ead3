#pragma once
// Where arrays live: the host's memory, or a device's, which the host may not read.
#include <concepts>
#include <cstddef>
#include <cstring>

#include "mpm/fields/aligned.hpp"

namespace mpm {

/// A space gives memory on cache-line boundaries, which its Block owns, and takes and gives what
/// the host has. What lies in a space is read only by code that runs there.
template <class Space>
concept MemorySpace = requires(std::size_t bytes, void* there, const void* here) {
  requires std::movable<typename Space::Block> && std::default_initializable<typename Space::Block>;
  { Space::allocate(bytes) } -> std::same_as<typename Space::Block>;
  Space::from_host(there, here, bytes);
  Space::to_host(there, here, bytes);
};

struct HostSpace {
  using Block = Memory;
  static Block allocate(std::size_t bytes) { return Memory(bytes); }
  static void from_host(void* to, const void* from, std::size_t bytes) {
    std::memcpy(to, from, bytes);
  }
  static void to_host(void* to, const void* from, std::size_t bytes) {
    std::memcpy(to, from, bytes);
  }
};
static_assert(MemorySpace<HostSpace>);

/// An owning array of T in a space. `release_and_allocate` discards the old content; the new one is
/// never initialised behind one's back.
template <class T, MemorySpace Space = HostSpace>
class AlignedArray {
 public:
  T* data() { return static_cast<T*>(memory_.data()); }
  const T* data() const { return static_cast<const T*>(memory_.data()); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

  void release_and_allocate(std::size_t n) {
    memory_ = typename Space::Block();
    size_ = 0;
    if (n == 0) return;
    memory_ = Space::allocate(n * sizeof(T));
    size_ = n;
  }

 private:
  typename Space::Block memory_;
  std::size_t size_ = 0;
};

/// Let an array of scratch hold n; its content is lost. It gets `room`, so that numbers which creep
/// up seldom allocate.
template <class T>
void make_room(AlignedArray<T>& array, std::size_t n, std::size_t room) {
  if (n > array.size()) array.release_and_allocate(room);
}

}  // namespace mpm
