#pragma once

namespace mpm {

/// Let the allocator give large blocks back to the system when they are freed, and what it has kept
/// so far. By default glibc raises the size from which it does so (M_MMAP_THRESHOLD) to that of the
/// largest block freed, up to 32 MiB, and keeps smaller ones for itself: a run, which takes and
/// frees large arrays only at its start and for a frame, would hold them to its end. Returns
/// whether the allocator can be told; others than glibc's cannot, by this function.
bool return_freed_memory();

}  // namespace mpm
