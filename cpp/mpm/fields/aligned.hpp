#pragma once
// Memory on cache-line boundaries that grows by whole allocations and is never initialised behind
// one's back.
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace mpm {

inline constexpr std::size_t cache_line = 64;

struct FreeDeleter {
  void operator()(void* p) const { std::free(p); }
};

/// An owning array of T, aligned to a cache line. `release_and_allocate` discards the old content.
template <class T>
class AlignedArray {
 public:
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

  void release_and_allocate(std::size_t n) {
    data_.reset();
    size_ = n;
    if (n == 0) return;
    const std::size_t bytes = (n * sizeof(T) + cache_line - 1) / cache_line * cache_line;
    data_.reset(static_cast<T*>(std::aligned_alloc(cache_line, bytes)));
    if (!data_) throw std::bad_alloc();
  }

 private:
  std::unique_ptr<T[], FreeDeleter> data_;
  std::size_t size_ = 0;
};

/// Let an array of scratch hold n; its content is lost. It gets `room`, so that numbers which creep
/// up seldom allocate.
template <class T>
void make_room(AlignedArray<T>& array, std::size_t n, std::size_t room) {
  if (n > array.size()) array.release_and_allocate(room);
}

}  // namespace mpm
