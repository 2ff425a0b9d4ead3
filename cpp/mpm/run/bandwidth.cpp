#include "mpm/run/bandwidth.hpp"

#include <algorithm>
#include <chrono>

#include "mpm/fields/aligned.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {

double measure_bandwidth(int count) {
  constexpr std::size_t n = std::size_t{1} << 24;  // 128 MiB an array
  constexpr std::size_t chunk = std::size_t{1} << 16;
  constexpr int repeats = 6;
  AlignedArray<double> a, b, c;
  for (auto* array : {&a, &b, &c}) {
    array->release_and_allocate(n);
    std::fill_n(array->data(), n, 1.0);
  }
  Threads threads(count);
  double best = 0.0;
  for (int r = 0; r < repeats; ++r) {
    const double s = 1.0 + r;
    const auto begin = std::chrono::steady_clock::now();
    threads.for_each(n / chunk, [&](std::size_t k) {
      for (std::size_t i = k * chunk; i < (k + 1) * chunk; ++i)
        a.data()[i] = b.data()[i] + s * c.data()[i];
    });
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    best = std::max(best, 3.0 * sizeof(double) * n / seconds / 1e9);
  }
  return best;
}

}  // namespace mpm
