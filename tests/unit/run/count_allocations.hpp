#pragma once
// Counts what is taken from the heap, by any thread of the program or module this is linked into.
#include <cstddef>

namespace mpm::testing {

/// Allocations so far: malloc and its relatives, and with them operator new and all containers.
std::size_t allocation_count();

}  // namespace mpm::testing
