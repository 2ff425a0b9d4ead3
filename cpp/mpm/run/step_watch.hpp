#pragma once
// Each step judged by those before it: time steps that collapse, steps that make energy.
#include <algorithm>
#include <array>
#include <cmath>

namespace mpm {

/// The last values, as many as there are, and their median.
struct LastValues {
  static constexpr std::size_t window = 1000;
  std::array<double, window> values{};
  std::size_t seen = 0;

  void add(double value) { values[seen++ % window] = value; }
  bool finite() const {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  }
  double median() const {
    const std::size_t n = std::min(seen, window);
    if (n == 0) return 0.0;
    std::array<double, window> sorted = values;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(n / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(n));
    return *middle;
  }
};

/// Judges each step by those before it. Trivially copyable.
class StepWatch {
 public:
  static constexpr std::size_t first_steps = 10;  // of a run, or of a load's work, are not judged
  static constexpr double drop = 0.1;             // of the median time step
  static constexpr double share = 0.05;           // of the largest energy so far
  static constexpr double jump = 10.0;  // load's work over its median; a smooth load keeps below

  /// The median of the last time steps, or of earlier ones if that was larger, if `time_step` lies
  /// below a tenth of it, else 0: a step may fall slowly too.
  double median_fallen_below(double time_step) {
    if (!std::isfinite(time_step)) return 0.0;  // All particles are gone.
    const double found = time_step < drop * median_ ? median_ : 0.0;
    steps_.add(time_step);
    // Found anew now and then: some ten operations a step.
    const std::size_t often = steps_.seen < LastValues::window ? 50 : LastValues::window;
    if (steps_.seen == first_steps || steps_.seen % often == 0)
      median_ = std::max(median_, steps_.median());
    return found;
  }
  /// The energy that numerics have made in a step, if it is more than a twentieth of `largest`.
  double energy_made(double made, double largest) {
    const double step = made - made_before_;
    made_before_ = made;
    return steps_.seen > first_steps && step > share * largest ? step : 0.0;
  }
  /// The work of loads in a step, likewise, if it is also more than ten times its median: a load
  /// that starts a body from rest, constant or as a power of time, does not more than 2^3 times.
  double load_energy(double work, double largest) {
    const double step = std::abs(work - work_before_);
    work_before_ = work;
    if (step == 0.0) return 0.0;
    const bool much = loads_.seen > first_steps && step > share * largest;
    const double found = much && step > jump * loads_.median() ? step : 0.0;
    loads_.add(step);
    return found;
  }
  /// Can steps have left it so? What is restored may be anything.
  bool plausible() const {
    return steps_.finite() && loads_.finite() && std::isfinite(median_) &&
           std::isfinite(made_before_) && std::isfinite(work_before_);
  }
  /// Work that somebody has done between two steps is none of the next one's.
  void start_from(double made, double work) {
    made_before_ = made;
    work_before_ = work;
  }

 private:
  LastValues steps_, loads_;
  double median_ = 0.0;  // the largest so far
  double made_before_ = 0.0, work_before_ = 0.0;
};

}  // namespace mpm
