#pragma once
// What this build can do at best on the machine, with so many threads: limits no step can pass.

namespace mpm {

/// Memory bandwidth [GB/s]: the best of several runs of a = b + s c over arrays far larger than any
/// cache (the triad of McCalpin's STREAM, 1995), counting the two reads and the write.
double measure_bandwidth(int threads);

/// Additions and multiplications a second [1e9/s]: the best of several runs of x = a x + b in as
/// many registers as hide the latency, of the width that this build uses.
double measure_arithmetic(int threads);

}  // namespace mpm
