#pragma once
// The host's memory, on cache-line boundaries.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
// The sanitizer watches the borders of what comes from the allocator only.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#define MPM_MAPS_MEMORY
#include <sys/mman.h>
#endif

namespace mpm {

inline constexpr std::size_t cache_line = 64;

/// Gives back what came from the system, `mapped` bytes, or from the allocator, if that is 0.
struct Release {
  std::size_t mapped = 0;
  void operator()(void* p) const {
#ifdef MPM_MAPS_MEMORY
    if (mapped > 0) {
      munmap(p, mapped);
      return;
    }
#endif
    std::free(p);
  }
};

/// Memory for large arrays comes from the system in huge pages, so that finding the page of an
/// address seldom costs more than the access; and goes back to the system at once, where an
/// allocator might keep it beside what takes its place. A last part of less than a huge page has
/// small ones.
class Memory {
 public:
  Memory() = default;
  explicit Memory(std::size_t bytes) {
#ifdef MPM_MAPS_MEMORY
    if (bytes >= 2 * huge_page) {
      // More is asked for than needed, and what lies before and behind is given back.
      const std::size_t asked = rounded_up(bytes, small_page) + huge_page;
      void* const got =
          mmap(nullptr, asked, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (got == MAP_FAILED) throw std::bad_alloc();
      auto* const start = static_cast<std::byte*>(got);
      const auto address = reinterpret_cast<std::uintptr_t>(start);
      const std::size_t before = rounded_up(address, huge_page) - address;
      const std::size_t mapped = asked - huge_page;
      if (before > 0) munmap(start, before);
      munmap(start + before + mapped, huge_page - before);
      // Refused where there are none: small ones do as well.
      madvise(start + before, bytes / huge_page * huge_page, MADV_HUGEPAGE);
      memory_ = {start + before, Release{mapped}};
      return;
    }
#endif
    memory_.reset(std::aligned_alloc(cache_line, rounded_up(bytes, cache_line)));
    if (!memory_) throw std::bad_alloc();
  }
  void* data() const { return memory_.get(); }

 private:
  static constexpr std::size_t small_page = 1 << 16;  // or a part of it
  static constexpr std::size_t huge_page = std::size_t{1} << 21;
  static constexpr std::size_t rounded_up(std::size_t n, std::size_t unit) {
    return (n + unit - 1) / unit * unit;
  }
  std::unique_ptr<void, Release> memory_;
};

}  // namespace mpm
