#pragma once
// What numbers a value may be: one form for parameters of materials and settings of a case.
#include <cmath>
#include <limits>
#include <string>

namespace mpm {

/// The numbers from `lower` to `upper`; an open bound is not one of them.
struct Rule {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = true, upper_open = true;
  bool finite = true;  // else an infinite one will do too

  static const Rule any, positive, not_negative, fraction, share, poisson_ratio;

  bool operator==(const Rule&) const = default;
  bool allows(double value) const {
    const bool above = lower_open ? value > lower : value >= lower;
    const bool below = upper_open && finite ? value < upper : value <= upper;
    return (std::isfinite(value) || (!finite && std::isinf(value))) && above && below;
  }
  /// What it demands, in words: "must be > 0".
  std::string text() const;
  /// The same as a formula of a number f, empty where any will do: "> 0", "0 < f <= 1".
  std::string formula() const;
};

inline constexpr Rule Rule::any{};
inline constexpr Rule Rule::positive{.lower = 0.0};
inline constexpr Rule Rule::not_negative{.lower = 0.0, .lower_open = false};
inline constexpr Rule Rule::fraction{.lower = 0.0, .upper = 1.0, .upper_open = false};
inline constexpr Rule Rule::share{
    .lower = 0.0, .upper = 1.0, .lower_open = false, .upper_open = false};
inline constexpr Rule Rule::poisson_ratio{.lower = -1.0, .upper = 0.5};

}  // namespace mpm
