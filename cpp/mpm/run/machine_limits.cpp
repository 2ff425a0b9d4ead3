#include "mpm/run/machine_limits.hpp"

#include <algorithm>
#include <chrono>

#include "mpm/fields/memory_space.hpp"
#include "mpm/math/batch.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {
namespace {

/// Seconds that the fastest of several runs of f(number of the run) takes.
template <class F>
double least_seconds(F&& f) {
  constexpr int repeats = 6;
  double least = 1e9;
  for (int r = 0; r < repeats; ++r) {
    const auto begin = std::chrono::steady_clock::now();
    f(r);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    least = std::min(least, spent.count());
  }
  return least;
}

}  // namespace

double measure_bandwidth(int count) {
  constexpr std::size_t n = std::size_t{1} << 24;  // 128 MiB an array
  constexpr std::size_t chunk = std::size_t{1} << 16;
  AlignedArray<double> a, b, c;
  for (auto* array : {&a, &b, &c}) {
    array->release_and_allocate(n);
    std::fill_n(array->data(), n, 1.0);
  }
  Threads threads(count);
  const double seconds = least_seconds([&](int r) {
    const double s = 1.0 + r;
    threads.for_each(n / chunk, [&](std::size_t k) {
      for (std::size_t i = k * chunk; i < (k + 1) * chunk; ++i)
        a.data()[i] = b.data()[i] + s * c.data()[i];
    });
  });
  return 3.0 * sizeof(double) * n / seconds / 1e9;
}

double measure_arithmetic(int count) {
  using T = Batch<native_lanes>;
  constexpr int registers = 10, turns = 1 << 16;  // of a share
  Threads threads(count);
  const std::size_t shares = 16 * static_cast<std::size_t>(threads.count());
  AlignedArray<double> sums;
  sums.release_and_allocate(shares);
  const double seconds = least_seconds([&](int r) {
    const T a(0.5 + 0.01 * r), b(1.0 + r);
    threads.for_each(shares, [&](std::size_t share) {
      T x[registers];
      for (int k = 0; k < registers; ++k) x[k] = T(static_cast<double>(k));
      for (int turn = 0; turn < turns; ++turn)
        for (auto& y : x) y = a * y + b;
      for (int k = 1; k < registers; ++k) x[0] += x[k];
      sums.data()[share] = sum(x[0]);  // so that the loop is not left out
    });
  });
  return 2.0 * native_lanes * registers * turns * static_cast<double>(shares) / seconds / 1e9;
}

}  // namespace mpm
