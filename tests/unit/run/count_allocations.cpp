// The linker sends every call of an allocating function through its __wrap_ namesake here (see
// cmake/testing.cmake).
#include "count_allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> allocations{0};
void count_one() { allocations.fetch_add(1, std::memory_order_relaxed); }
}  // namespace

std::size_t mpm::testing::allocation_count() { return allocations.load(); }

// NOLINTBEGIN: the linker gives these names
extern "C" {
void* __real_malloc(std::size_t);
void* __real_calloc(std::size_t, std::size_t);
void* __real_realloc(void*, std::size_t);
void* __real_aligned_alloc(std::size_t, std::size_t);
int __real_posix_memalign(void**, std::size_t, std::size_t);
void* __real__Znwm(std::size_t);
void* __real__ZnwmSt11align_val_t(std::size_t, std::align_val_t);

void* __wrap_malloc(std::size_t size) {
  count_one();
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t n, std::size_t size) {
  count_one();
  return __real_calloc(n, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  count_one();
  return __real_realloc(old, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  count_one();
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** to, std::size_t alignment, std::size_t size) {
  count_one();
  return __real_posix_memalign(to, alignment, size);
}
// operator new and its over-aligned form, where the C++ library is shared and its malloc out of
// reach.
void* __wrap__Znwm(std::size_t size) {
  count_one();
  return __real__Znwm(size);
}
void* __wrap__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment) {
  count_one();
  return __real__ZnwmSt11align_val_t(size, alignment);
}
}
// NOLINTEND
