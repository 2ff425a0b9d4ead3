// mpm3dpp._testing: the C++ unit tests for pytest, as `tests`: name -> callable -> (checks,
// failures).
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "list.hpp"

namespace nb = nanobind;

NB_MODULE(_testing, module) {
  nb::dict tests;
  for (const auto& test : mpm::testing::unit_tests) {
    tests[nb::str(test.name.data(), test.name.size())] = nb::cpp_function([run = test.run] {
      mpm::testing::Report report;
      run(report);
      return std::pair(report.check_count(), report.failures());
    });
  }
  module.attr("tests") = tests;
}
