#pragma once
// The device's shared object, loaded when a device is asked for: where there is none, nothing of
// CUDA is needed.
#include <memory>

#include "mpm/device/device_run.hpp"

namespace mpm {

struct DeviceLibrary {
  void (*info)(DeviceInfo&, std::string&) = nullptr;
  DeviceRun<2>* (*run_2)(const DeviceProblem<2>&) = nullptr;
  DeviceRun<3>* (*run_3)(const DeviceProblem<3>&) = nullptr;
};

/// Throws std::runtime_error, in one sentence, if this build has none, or it cannot be loaded.
const DeviceLibrary& device_library();

inline std::unique_ptr<DeviceRun<2>> make_device_run(const DeviceProblem<2>& problem) {
  return std::unique_ptr<DeviceRun<2>>(device_library().run_2(problem));
}
inline std::unique_ptr<DeviceRun<3>> make_device_run(const DeviceProblem<3>& problem) {
  return std::unique_ptr<DeviceRun<3>>(device_library().run_3(problem));
}

}  // namespace mpm
