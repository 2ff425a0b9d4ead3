#pragma once
// The smallest harness that names what failed: a test is a function `void test_name(Report&
// report)`.
#include <cmath>
#include <cstddef>
#include <exception>
#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace mpm::testing {

/// What one test found. A test that checked nothing has not passed.
class Report {
 public:
  /// Count one check and, if it failed, keep "file:line: what; name = value ...".
  template <class... Values>
  void check(bool passed, const char* file, int line, std::string_view what, std::string_view names,
             const Values&... values) {
    ++check_count_;
    if (passed || ++failure_count_ > most_kept) return;
    std::ostringstream text;
    text << std::setprecision(17) << file << ':' << line << ": " << what;
    if constexpr (sizeof...(values) > 0) {
      text << "; (" << names << ") =";
      ((text << ' ' << values), ...);
    }
    failures_.push_back(text.str());
  }
  std::size_t check_count() const { return check_count_; }
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  static constexpr std::size_t most_kept = 20;  // a million do not tell more
  std::size_t check_count_ = 0, failure_count_ = 0;
  std::vector<std::string> failures_;
};

/// |actual - expected| <= tolerance; false for NaN.
inline bool close(double actual, double expected, double tolerance) {
  return std::abs(actual - expected) <= tolerance;
}

/// True if `call` throws a std::exception whose text holds `part`.
template <class Call>
bool throws(Call&& call, std::string_view part) {
  try {
    call();
  } catch (const std::exception& error) {
    return std::string_view(error.what()).find(part) != std::string_view::npos;
  }
  return false;
}

}  // namespace mpm::testing

/// CHECK(condition) or CHECK(condition, value, ...): the values are printed when it fails.
#define CHECK(condition, ...) \
  report.check((condition), __FILE__, __LINE__, #condition, #__VA_ARGS__ __VA_OPT__(, ) __VA_ARGS__)

#define CHECK_EQUAL(actual, expected)                                                \
  report.check((actual) == (expected), __FILE__, __LINE__, #actual " == " #expected, \
               #actual ", " #expected, (actual), (expected))

#define CHECK_CLOSE(actual, expected, tolerance)                                           \
  report.check(mpm::testing::close((actual), (expected), (tolerance)), __FILE__, __LINE__, \
               "|" #actual " - (" #expected ")| <= " #tolerance,                           \
               #actual ", " #expected ", " #tolerance, (actual), (expected), (tolerance))

#define CHECK_THROWS(expression, part)                                                      \
  report.check(mpm::testing::throws([&] { (void)(expression); }, part), __FILE__, __LINE__, \
               #expression " throws \"" part "\"", "")
