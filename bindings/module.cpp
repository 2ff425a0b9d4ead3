// The Python module mpm3dpp._core: translates between Python and the core, and nothing else.
#include "mpm/fields/columns.hpp"
#include "mpm/run/allocator.hpp"
#include "mpm/run/machine_limits.hpp"
#include "translate.hpp"

#if defined(__clang__)
#define MPM_COMPILER "clang++ " __clang_version__
#else
#define MPM_COMPILER "g++ " __VERSION__
#endif

using namespace mpm;
using namespace mpm::bindings;

NB_MODULE(_core, m) {
  m.doc() =
      "The compiled core of MPM3Dpp. SI units throughout; see mpm3dpp.Case for defaults and units.";

  add_settings(m);
  add_records(m);
  add_simulation(m);
  add_materials(m);
  m.def("measure_bandwidth", &measure_bandwidth, nb::arg("threads"),
        nb::call_guard<nb::gil_scoped_release>());
  m.def("measure_arithmetic", &measure_arithmetic, nb::arg("threads"),
        nb::call_guard<nb::gil_scoped_release>());
  m.def("return_freed_memory", &return_freed_memory);
  m.def("build_info", [] {
    nb::dict d;
    d["compiler"] = MPM_COMPILER;
    d["flags"] = MPM_BUILD_FLAGS;
    d["isa"] = native_lanes == 8 ? "AVX-512" : native_lanes == 4 ? "AVX" : "SSE2 or NEON";
    d["lanes"] = native_lanes;
    d["velocity_and_stress"] = std::is_same_v<Storage, float> ? "float32" : "float64";
    return d;
  });
}
