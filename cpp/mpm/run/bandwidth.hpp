#pragma once

namespace mpm {

/// Memory bandwidth of this machine [GB/s]: the best of several runs of a = b + s c over arrays far
/// larger than any cache (the triad of McCalpin's STREAM, 1995), counting the two reads and the
/// write.
double measure_bandwidth(int threads);

}  // namespace mpm
