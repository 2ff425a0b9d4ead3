#include "mpm/device/library.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>

#include <dlfcn.h>

namespace mpm {
namespace {

/// Beside the module or program that this is part of; tests have another (tests/device/emulated).
std::filesystem::path path_of_library() {
  Dl_info about{};
  dladdr(reinterpret_cast<void*>(&path_of_library), &about);
  const char* const other = std::getenv("MPM3DPP_DEVICE_LIBRARY");
  return std::filesystem::path(about.dli_fname).parent_path() /
         (other != nullptr ? other : "libmpm_device.so");
}

DeviceLibrary load(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw std::runtime_error(
        "this build has no code for a device: install it where there is CUDA's nvcc, with pip "
        "install . -C cmake.define.MPM_CUDA=ON");
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw std::runtime_error("the code for a device cannot be loaded: " + std::string(dlerror()));
  DeviceLibrary found;
  int (*version)() = nullptr;
  const auto find = [&](const char* name, auto& function) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    if (function == nullptr)
      throw std::runtime_error(path.string() + " is no code for a device: it lacks " + name);
  };
  find("mpm_device_version", version);
  if (version() != device_version)
    throw std::runtime_error(path.string() + " is of another version: build it again");
  find("mpm_device_info", found.info);
  find("mpm_device_run_2", found.run_2);
  find("mpm_device_run_3", found.run_3);
  return found;
}

}  // namespace

const DeviceLibrary& device_library() {
  static std::map<std::filesystem::path, DeviceLibrary> loaded;
  const std::filesystem::path path = path_of_library();
  auto found = loaded.find(path);
  if (found == loaded.end()) found = loaded.emplace(path, load(path)).first;
  return found->second;
}

}  // namespace mpm
