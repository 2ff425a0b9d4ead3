#pragma once
// A number that depends on time: loads and motions that a case prescribes.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace mpm {

/// constant + table(t) + amplitude sin(2 pi frequency t + phase). The table is linear between its
/// times and held before the first and after the last; it may be empty. A number alone is a
/// constant.
struct TimeFunction {
  double constant = 0.0, amplitude = 0.0;
  double frequency = 0.0, phase = 0.0;  // [Hz], [rad]
  std::vector<double> times, values;    // [s], equally many

  TimeFunction(double value = 0.0) : constant(value) {}

  /// The first rule that it breaks, in words; empty if none.
  std::string problem() const {
    if (times.size() != values.size()) return "must have as many values as times";
    for (const double number : {constant, amplitude, frequency, phase})
      if (!std::isfinite(number)) return "must have finite numbers";
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (!std::isfinite(times[k]) || !std::isfinite(values[k])) return "must have finite numbers";
      if (k > 0 && !(times[k] > times[k - 1])) return "must have increasing times";
    }
    return {};
  }

  /// Is it zero at all times?
  bool vanishes() const {
    return constant == 0.0 && amplitude == 0.0 &&
           std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
  }

  /// Numbers that it never falls below and never exceeds; with a sine beside a table not the
  /// closest ones.
  double lower_bound() const {
    const double table = values.empty() ? 0.0 : *std::min_element(values.begin(), values.end());
    return constant + table - std::abs(amplitude);
  }
  double upper_bound() const {
    const double table = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
    return constant + table + std::abs(amplitude);
  }

  /// Value at a time [s].
  double at(double t) const { return constant + table_at(t) + amplitude * std::sin(angle(t)); }

  /// Mean from one time to a later one [s], exact but for rounding: over the steps of a run it adds
  /// up to the integral.
  double mean(double from, double to) const {
    if (!(to > from)) return at(from);
    // The mean of a sine is that of the middle, times sin(x) / x.
    const double half = std::numbers::pi * frequency * (to - from);
    const double factor = half != 0.0 ? std::sin(half) / half : 1.0;
    return constant + table_mean(from, to) +
           amplitude * factor * std::sin(angle(0.5 * (from + to)));
  }

 private:
  double angle(double t) const { return 2.0 * std::numbers::pi * frequency * t + phase; }

  double table_at(double t) const {
    if (times.empty()) return 0.0;
    const auto next = std::upper_bound(times.begin(), times.end(), t);
    if (next == times.begin()) return values.front();
    if (next == times.end()) return values.back();
    const auto k = static_cast<std::size_t>(next - times.begin());
    const double share = (t - times[k - 1]) / (times[k] - times[k - 1]);
    return values[k - 1] + share * (values[k] - values[k - 1]);
  }

  double table_mean(double from, double to) const {
    auto k = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), from) -
                                      times.begin());
    double t = from, value = table_at(from);
    if (k == times.size() || times[k] >= to) return 0.5 * (value + table_at(to));
    double sum = 0.0;
    for (; k < times.size() && times[k] < to; ++k) {
      sum += 0.5 * (value + values[k]) * (times[k] - t);
      t = times[k];
      value = values[k];
    }
    return (sum + 0.5 * (value + table_at(to)) * (to - t)) / (to - from);
  }
};

}  // namespace mpm
