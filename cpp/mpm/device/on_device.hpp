#pragma once
// Steps of a domain on a device. The device has the particles then, and the host what it has asked
// for last.
#include <memory>
#include <string>

#include "mpm/device/host_part.hpp"
#include "mpm/domain.hpp"
#include "mpm/step/scheme.hpp"

namespace mpm {

template <int D>
struct OnDevice {
  std::unique_ptr<DeviceRun<D>> run;
  std::vector<bool> has_pool;         // some of its particles are on the device
  std::unique_ptr<HostPart<D>> host;  // null if the device makes all of a step
  HostSeconds seconds;
  DeviceReport report;
  bool stress_first = false;
  bool ahead = false;  // of the host: steps have been made since it was given the particles
  bool gone = false;   // the host has to take out particles before the next step
};

/// The device of this machine. Throws std::runtime_error, in one sentence, if there is none.
DeviceInfo device_info();

/// What a domain has that steps on a device do not know yet, in words; empty if there is nothing.
template <int D>
std::string not_on_device(const Domain<D>& domain, Scheme scheme);

/// Give the particles to the device. Throws std::runtime_error, in one sentence, if there is none,
/// or too little memory; std::invalid_argument for what it does not know.
template <int D>
std::unique_ptr<OnDevice<D>> start_on_device(Domain<D>& domain, Scheme scheme);

/// All stages of a step; the domain has its sums after it, of bodies, and `look` says whether
/// particles that somebody should look at are counted.
template <int D>
void step_on_device(OnDevice<D>& device, Domain<D>& domain, bool look);

/// Let the host have the particles as they are now.
template <int D>
void fetch_from_device(OnDevice<D>& device, Domain<D>& domain);

}  // namespace mpm
