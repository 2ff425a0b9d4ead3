// The C++ unit tests without Python, for sanitizers and debuggers:  unit_tests [NAME ...], or every
// second of them, unit_tests 0/2 and unit_tests 1/2.
#include <cstdio>
#include <exception>
#include <span>
#include <string>

#include "list.hpp"

namespace {

/// Is it named, or of a share "k/n", each n-th from number k on?
bool selected(std::string_view name, int number, std::span<char*> wanted) {
  for (const char* each : wanted) {
    int from = 0, share = 0;
    if (std::sscanf(each, "%d/%d", &from, &share) == 2 && share > 0 && number % share == from)
      return true;
    if (name == each) return true;
  }
  return wanted.empty();
}

/// Run one test, print what failed; true if it checked something and nothing failed.
bool passes(const mpm::testing::UnitTest& test) {
  const std::string name(test.name);
  mpm::testing::Report report;
  try {
    test.run(report);
  } catch (const std::exception& error) {
    std::printf("%s: threw: %s\n", name.c_str(), error.what());
    return false;
  }
  for (const auto& failure : report.failures()) {
    std::printf("%s: %s\n", name.c_str(), failure.c_str());
  }
  if (report.check_count() == 0) std::printf("%s: checked nothing\n", name.c_str());
  return report.check_count() > 0 && report.failures().empty();
}

}  // namespace

int main(int argc, char** argv) {
  const std::span<char*> wanted(argv + 1, argv + argc);
  int passed = 0;
  int failed = 0;
  int number = 0;
  for (const auto& test : mpm::testing::unit_tests) {
    if (selected(test.name, number++, wanted)) ++(passes(test) ? passed : failed);
  }
  std::printf("%d passed, %d failed\n", passed, failed);
  return failed > 0 || passed == 0 ? 1 : 0;
}
