#pragma once
// The smallest harness that names what failed: a test is a function `void test_name(Report&
// report)`.
#include <cmath>
#include <cstddef>
#include <exception>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace mpm::testing {

/// What 1 and the number after it differ by.
inline constexpr double eps = std::numeric_limits<double>::epsilon();

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
  template <class A, class B>
  void check_equal(const A& actual, const B& expected, const char* file, int line,
                   std::string_view what, std::string_view names) {
    check(actual == expected, file, line, what, names, actual, expected);
  }
  /// |actual - expected| <= tolerance; not so for NaN.
  void check_close(double actual, double expected, double tolerance, const char* file, int line,
                   std::string_view what, std::string_view names) {
    const bool close = std::abs(actual - expected) <= tolerance;
    check(close, file, line, what, names, actual, expected, tolerance);
  }
  std::size_t check_count() const { return check_count_; }
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  static constexpr std::size_t most_kept = 20;  // a million do not tell more
  std::size_t check_count_ = 0, failure_count_ = 0;
  std::vector<std::string> failures_;
};

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

#define CHECK_EQUAL(actual, expected)                                                    \
  report.check_equal((actual), (expected), __FILE__, __LINE__, #actual " == " #expected, \
                     #actual ", " #expected)

#define CHECK_CLOSE(actual, expected, tolerance)                            \
  report.check_close((actual), (expected), (tolerance), __FILE__, __LINE__, \
                     "|" #actual " - (" #expected ")| <= " #tolerance,      \
                     #actual ", " #expected ", " #tolerance)

#define CHECK_THROWS(expression, part)                                                      \
  report.check(mpm::testing::throws([&] { (void)(expression); }, part), __FILE__, __LINE__, \
               #expression " throws \"" part "\"", "")
