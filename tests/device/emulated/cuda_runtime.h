#pragma once
// As much of CUDA's run time as the code for a device uses, on the processor: g++ compiles the same
// kernels, and a block's threads are fibers that take turns at barriers (emulated.cpp). So every
// change of a kernel is tested where there is no card. It is slow, and finds no races.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>

#define __global__
#define __device__
#define __host__
#define __shared__ static
#define __launch_bounds__(...)

struct dim3 {
  unsigned x = 1, y = 1, z = 1;
  dim3(unsigned of_x = 1, unsigned of_y = 1, unsigned of_z = 1) : x(of_x), y(of_y), z(of_z) {}
};

namespace emulated {

/// Which thread runs.
extern dim3 thread, block, block_size, grid_size;

/// Run `kernel` for each thread of each block, one block after another.
void run(dim3 blocks, unsigned threads, const std::function<void()>& kernel);

/// Wait for all threads of the block that have not ended; how many of them have voted.
int wait_for_block(bool vote);
/// Wait for those of the warp that are in the mask.
void wait_for_warp(unsigned mask);
/// The value that the thread at a lane of the warp has given.
double exchange(double value, int lane);
std::uint32_t exchange(std::uint32_t value, int lane);

}  // namespace emulated

#define threadIdx emulated::thread
#define blockIdx emulated::block
#define blockDim emulated::block_size
#define gridDim emulated::grid_size

inline void __syncthreads() { emulated::wait_for_block(false); }
inline int __syncthreads_or(int vote) { return emulated::wait_for_block(vote != 0) > 0; }
inline int __syncthreads_count(int vote) { return emulated::wait_for_block(vote != 0); }
inline void __syncwarp(unsigned mask = ~0u) { emulated::wait_for_warp(mask); }
template <class T>
T __shfl_down_sync(unsigned, T value, int by) {
  const int lane = static_cast<int>(threadIdx.x % 32u) + by;
  return emulated::exchange(value, lane < 32 ? lane : lane - by);
}
template <class T>
T __shfl_up_sync(unsigned, T value, int by) {
  const int lane = static_cast<int>(threadIdx.x % 32u) - by;
  return emulated::exchange(value, lane >= 0 ? lane : lane + by);
}
inline std::uint32_t atomicAdd(std::uint32_t* to, std::uint32_t x) {
  const std::uint32_t before = *to;
  *to += x;
  return before;
}
inline int __popc(unsigned x) { return __builtin_popcount(x); }
template <class T>
T max(T x, T y) {
  return x < y ? y : x;
}
template <class T>
T min(T x, T y) {
  return y < x ? y : x;
}

using cudaError_t = int;
inline constexpr cudaError_t cudaSuccess = 0, cudaErrorMemoryAllocation = 2;
inline const char* cudaGetErrorString(cudaError_t) { return "an error of the emulation"; }
inline cudaError_t cudaGetLastError() { return cudaSuccess; }
inline cudaError_t cudaDeviceSynchronize() { return cudaSuccess; }

template <class T>
cudaError_t cudaMalloc(T** to, std::size_t bytes) {
  *to = static_cast<T*>(std::malloc(bytes));
  if (*to == nullptr) return cudaErrorMemoryAllocation;
  std::memset(*to, 0xcb, bytes);  // so that what reads before it writes is seen
  return cudaSuccess;
}
template <class T>
cudaError_t cudaMallocHost(T** to, std::size_t bytes) {
  return cudaMalloc(to, bytes);
}
inline cudaError_t cudaFree(void* of) {
  std::free(of);
  return cudaSuccess;
}
inline cudaError_t cudaFreeHost(void* of) { return cudaFree(of); }
enum cudaMemcpyKind { cudaMemcpyHostToDevice, cudaMemcpyDeviceToHost, cudaMemcpyDeviceToDevice };
inline cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind) {
  if (bytes > 0) std::memcpy(to, from, bytes);
  return cudaSuccess;
}
inline cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes,
                                   cudaMemcpyKind kind) {
  return cudaMemcpy(to, from, bytes, kind);
}
inline cudaError_t cudaMemset(void* to, int value, std::size_t bytes) {
  if (bytes > 0) std::memset(to, value, bytes);
  return cudaSuccess;
}
inline cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes) {
  return cudaMemset(to, value, bytes);
}

using cudaEvent_t = int;
inline cudaError_t cudaEventCreate(cudaEvent_t* made) {
  *made = 1;
  return cudaSuccess;
}
inline cudaError_t cudaEventDestroy(cudaEvent_t) { return cudaSuccess; }
inline cudaError_t cudaEventRecord(cudaEvent_t) { return cudaSuccess; }
inline cudaError_t cudaEventElapsedTime(float* to, cudaEvent_t, cudaEvent_t) {
  *to = 1.0F;
  return cudaSuccess;
}

struct cudaDeviceProp {
  char name[32];
  int major, multiProcessorCount, memoryBusWidth;
};
enum cudaDeviceAttr { cudaDevAttrMemoryClockRate, cudaDevAttrClockRate };
inline cudaError_t cudaGetDeviceCount(int* count) {
  *count = 1;
  return cudaSuccess;
}
inline cudaError_t cudaDriverGetVersion(int* version) {
  *version = 1;
  return cudaSuccess;
}
inline cudaError_t cudaGetDeviceProperties(cudaDeviceProp* card, int) {
  *card = {"an emulated card", 9, 1, 1024};
  return cudaSuccess;
}
inline cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* bytes) {
  *free_bytes = *bytes = std::size_t{1} << 33;
  return cudaSuccess;
}
inline cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr, int) {
  *value = 1000000;
  return cudaSuccess;
}
