#pragma once
// The seam to devices: functions marked MPM_HD compile for them too (nvcc), where a number is a
// double, and no vector type is known.
#if defined(__CUDACC__)
#define MPM_HD __host__ __device__
#else
#define MPM_HD
#endif

/// For lambdas in the innermost loops: g++ leaves some of them as calls, with what they capture in
/// memory.
#define MPM_INLINE __attribute__((always_inline))

/// Everything that a function calls is inlined; what it calls seldom is kept out of it. A device's
/// compiler inlines all by itself.
#if defined(__CUDACC__)
#define MPM_FLATTEN
#define MPM_COLD
#else
#define MPM_FLATTEN [[gnu::flatten]]
#define MPM_COLD [[gnu::noinline, gnu::cold]]
#endif

// Where the processor can, a b + c is rounded once; never where bits are to be the same on all. A
// device always can.
#if (defined(__FMA__) || defined(__aarch64__) || defined(__CUDA_ARCH__)) && !defined(MPM_SAME_BITS)
#define MPM_FUSES
#endif
