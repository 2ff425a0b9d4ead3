// What the core calls of the device's shared object.
#include "mpm/device/cuda/memory.cuh"
#include "mpm/device/device_run.hpp"

namespace mpm {
DeviceRun<2>* make_run(const DeviceProblem<2>& problem);
DeviceRun<3>* make_run(const DeviceProblem<3>& problem);
}  // namespace mpm

#define MPM_EXPORT __attribute__((visibility("default")))

extern "C" {

MPM_EXPORT int mpm_device_version() { return mpm::device_version; }

MPM_EXPORT void mpm_device_info(mpm::DeviceInfo& info, std::string& why) {
  info = {};
  int count = 0;
  const cudaError_t code = cudaGetDeviceCount(&count);
  if (code != cudaSuccess || count == 0) {
    int driver = 0;
    cudaDriverGetVersion(&driver);
    why = driver == 0           ? "there is no driver of an NVIDIA card"
          : code == cudaSuccess ? "there is no NVIDIA card"
                                : cudaGetErrorString(code);
    return;
  }
  cudaDeviceProp card;
  mpm::check_cuda(cudaGetDeviceProperties(&card, 0), "asking for the card");
  if (card.major < 9) {
    why = std::string(card.name) + " is older than this build is for (compute capability 9.0)";
    return;
  }
  info.name = card.name;
  mpm::check_cuda(cudaMemGetInfo(&info.free_bytes, &info.bytes), "asking for the card's memory");
  int memory_khz = 0, core_khz = 0;
  mpm::check_cuda(cudaDeviceGetAttribute(&memory_khz, cudaDevAttrMemoryClockRate, 0), "asking");
  mpm::check_cuda(cudaDeviceGetAttribute(&core_khz, cudaDevAttrClockRate, 0), "asking");
  info.bandwidth = 2.0 * 1e3 * memory_khz * card.memoryBusWidth / 8.0;
  info.fma_per_second = 64.0 * card.multiProcessorCount * 1e3 * core_khz;
}

MPM_EXPORT mpm::DeviceRun<2>* mpm_device_run_2(const mpm::DeviceProblem<2>& problem) {
  return mpm::make_run(problem);
}
MPM_EXPORT mpm::DeviceRun<3>* mpm_device_run_3(const mpm::DeviceProblem<3>& problem) {
  return mpm::make_run(problem);
}
}
