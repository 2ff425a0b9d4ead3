// Steps on a GPU.
#include "any.hpp"
#include "mpm/run/use_device.hpp"

namespace mpm::bindings {

void def_device(SimulationClass& simulation) {
  simulation.def("use_device", of_any([](auto& s) { use_device(s); }))
      .def_static("device",
                  [] {
                    const DeviceInfo info = device_info();
                    nb::dict d;
                    d["name"] = info.name;
                    d["bytes"] = info.bytes;
                    d["free_bytes"] = info.free_bytes;
                    d["bandwidth"] = info.bandwidth;
                    d["fma_per_second"] = info.fma_per_second;
                    return d;
                  })
      .def_prop_ro("device_bytes", of_any_as_is([](auto& s) {
                     return s.device ? s.device->run->bytes() : std::size_t{0};
                   }))
      .def_prop_ro("device_host_seconds",
                   as_is_to([](auto& s) { return s.device ? s.device->seconds : HostSeconds{}; },
                            [](const HostSeconds& seconds) {
                              nb::dict d;
                              d["particles to the host"] = seconds.particles;
                              d["lists of the host"] = seconds.lists;
                              d["stages of the host"] = seconds.stages;
                              return d;
                            }))
      .def(
          "device_times",
          as_is_to(
              [](auto& s) { return s.device ? s.device->run->times() : std::vector<DeviceTime>{}; },
              [](const auto& times) {
                nb::dict d;
                for (const DeviceTime& time : times)
                  d[time.name.c_str()] = 1e-3 * time.milliseconds;
                return d;
              }));
}

}  // namespace mpm::bindings
