#pragma once
// How long kernels take, by events between them; nothing where nobody asks.
#include <map>
#include <string>
#include <vector>

#include "mpm/device/cuda/memory.cuh"

namespace mpm {

class KernelTimer {
 public:
  KernelTimer() = default;
  KernelTimer(const KernelTimer&) = delete;
  KernelTimer& operator=(const KernelTimer&) = delete;
  ~KernelTimer() {
    for (const cudaEvent_t event : free_) cudaEventDestroy(event);
    for (const Span& span : spans_) {
      cudaEventDestroy(span.begin);
      cudaEventDestroy(span.end);
    }
  }

  /// work(), which starts kernels.
  template <class F>
  void time(const char* name, F&& work) {
    if (!asked_) return work();
    const Span span{name, event(), event()};
    cudaEventRecord(span.begin);
    work();
    cudaEventRecord(span.end);
    spans_.push_back(span);
  }
  /// Since the last time; from the first time on it is known.
  std::vector<DeviceTime> take() {
    asked_ = true;
    check_cuda(cudaDeviceSynchronize(), "timing kernels");
    std::map<std::string, double> sums;
    for (const Span& span : spans_) {
      float milliseconds = 0.0F;
      check_cuda(cudaEventElapsedTime(&milliseconds, span.begin, span.end), "timing kernels");
      sums[span.name] += milliseconds;
      free_.push_back(span.begin);
      free_.push_back(span.end);
    }
    spans_.clear();
    std::vector<DeviceTime> times;
    for (const auto& [name, milliseconds] : sums) times.push_back({name, milliseconds});
    return times;
  }

 private:
  struct Span {
    const char* name;
    cudaEvent_t begin, end;
  };
  cudaEvent_t event() {
    cudaEvent_t made;
    if (free_.empty()) {
      check_cuda(cudaEventCreate(&made), "timing kernels");
    } else {
      made = free_.back();
      free_.pop_back();
    }
    return made;
  }

  bool asked_ = false;
  std::vector<Span> spans_;
  std::vector<cudaEvent_t> free_;
};

}  // namespace mpm
