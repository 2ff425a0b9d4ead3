#pragma once
// Memory of the device, and errors of its library as exceptions.
#include <stdexcept>
#include <string>
#include <utility>

#include <cuda_runtime.h>

namespace mpm {

/// Bytes that this process has on the device.
inline std::size_t& device_bytes() {
  static std::size_t bytes = 0;
  return bytes;
}

inline void check_cuda(cudaError_t code, const char* doing) {
  if (code == cudaSuccess) return;
  if (code == cudaErrorMemoryAllocation) {
    cudaGetLastError();
    throw std::runtime_error(
        "the device has too little memory: take fewer particles or larger cells, or run without a "
        "device");
  }
  throw std::runtime_error(std::string("the device failed while ") + doing + ": " +
                           cudaGetErrorString(code));
}

/// Start a kernel, a block of so many threads each; nothing where there is no block.
template <class... P, class... A>
void launch(void (*kernel)(P...), dim3 blocks, unsigned threads, A&&... with) {
  if (blocks.x == 0) return;
#if defined(MPM_EMULATED)
  emulated::run(blocks, threads, [&] { kernel(static_cast<P>(with)...); });
#else
  kernel<<<blocks, threads>>>(static_cast<P>(with)...);
#endif
}

/// An owning array on the device.
template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~DeviceArray() { release(); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  void swap(DeviceArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  void release() {
    if (data_ != nullptr) cudaFree(data_);
    device_bytes() -= size_ * sizeof(T);
    data_ = nullptr;
    size_ = 0;
  }
  void allocate(std::size_t n) {
    release();
    if (n == 0) return;
    check_cuda(cudaMalloc(&data_, n * sizeof(T)), "allocating memory");
    size_ = n;
    device_bytes() += n * sizeof(T);
  }
  /// Room for n; the content is lost where there was less. Some more, so that numbers which creep
  /// up seldom allocate.
  void need(std::size_t n) {
    if (n > size_) allocate(n + n / 16);
  }
  void take(const T* host, std::size_t n) {
    need(n);
    check_cuda(cudaMemcpy(data_, host, n * sizeof(T), cudaMemcpyHostToDevice), "taking data");
  }
  void give(T* host, std::size_t n, std::size_t first = 0) const {
    check_cuda(cudaMemcpy(host, data_ + first, n * sizeof(T), cudaMemcpyDeviceToHost),
               "giving data back");
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// An array of the host that the device writes to without a copy on the way.
template <class T>
class PinnedArray {
 public:
  PinnedArray() = default;
  PinnedArray(const PinnedArray&) = delete;
  PinnedArray& operator=(const PinnedArray&) = delete;
  ~PinnedArray() {
    if (data_ != nullptr) cudaFreeHost(data_);
  }
  void allocate(std::size_t n) {
    if (data_ != nullptr) cudaFreeHost(data_);
    data_ = nullptr;
    size_ = 0;
    check_cuda(cudaMallocHost(&data_, n * sizeof(T)), "allocating memory of the host");
    size_ = n;
  }
  std::size_t size() const { return size_; }
  T* data() { return data_; }
  T& operator[](std::size_t k) { return data_[k]; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace mpm
