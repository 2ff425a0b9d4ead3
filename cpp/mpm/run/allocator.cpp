#include "mpm/run/allocator.hpp"

#include <cstdlib>  // says which library this is

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace mpm {

bool return_freed_memory() {
#ifdef __GLIBC__
  constexpr int block = 128 * 1024;  // glibc's own value at the start; once set it does not move
  const bool told = mallopt(M_MMAP_THRESHOLD, block) == 1 && mallopt(M_TRIM_THRESHOLD, block) == 1;
  malloc_trim(0);
  return told;
#else
  return false;
#endif
}

}  // namespace mpm
