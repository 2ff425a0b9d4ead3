#pragma once
// What a number must offer for a kernel or a model: the same source serves double (the oracle) and
// SIMD lanes.
#include <algorithm>
#include <cmath>
#include <concepts>

#include "mpm/math/elementary.hpp"
// A device has no vector types.
#if !defined(__CUDACC__)
#include "mpm/math/batch.hpp"
#include "mpm/math/batch_math.hpp"
#endif

namespace mpm {

// A device's double has the bits of lanes; the host's, the oracle, those of the library.
#if defined(__CUDA_ARCH__)
MPM_HD inline double log(double a) { return log_by_series(a); }
MPM_HD inline double exp(double a) { return exp_by_series(a); }
MPM_HD inline double pow(double a, double b) { return pow_by_series(a, b); }
#else
MPM_HD inline double log(double a) { return std::log(a); }
MPM_HD inline double exp(double a) { return std::exp(a); }
MPM_HD inline double pow(double a, double b) { return std::pow(a, b); }
#endif
MPM_HD inline double sum(double a) { return a; }
MPM_HD inline double largest(double a) { return a; }
MPM_HD inline bool any(bool a) { return a; }

/// Keeps a quotient, power or logarithm finite where its argument vanishes: below all that is
/// measured, and a normal number, which logarithms of lanes need.
inline constexpr double tiny = 1e-300;

/// Size of a number; below it, what a comparison of two numbers gives.
template <class T>
MPM_HD T absolute(T a) {
#if defined(__CUDA_ARCH__)
  return fabs(a);  // as of lanes: of zero without a sign
#else
  return max(a, -a);
#endif
}
template <class T>
using Truth = decltype(T(0.0) < T(0.0));

/// (1 + x)^a for |x| <= `reach` by the binomial series to x^9: the rest is below 2e-15 for 0 < a <
/// 3; beyond it is not `exact`.
struct PowerNearOne {
  static constexpr int terms = 9;
  static constexpr double reach = 0.05;
  double exponent = 0.0, factor[terms + 1] = {1.0};

  PowerNearOne() = default;
  MPM_HD explicit PowerNearOne(double a) : exponent(a) {
    for (int k = 1; k <= terms; ++k) factor[k] = factor[k - 1] * (a - (k - 1)) / k;
  }
  MPM_HD bool exact() const { return exponent < 3.0; }
  template <class T>
  MPM_HD T operator()(T x) const {
    T sum(factor[terms]);
    for (int k = terms - 1; k >= 0; --k) sum = fma(x, sum, T(factor[k]));
    return sum;
  }
};

/// A number: arithmetic, ordering, select.
template <class T>
concept Real = requires(T a, T b) {
  { a + b } -> std::convertible_to<T>;
  { a - b } -> std::convertible_to<T>;
  { a * b } -> std::convertible_to<T>;
  { a / b } -> std::convertible_to<T>;
  { select(a < b, a, b) } -> std::convertible_to<T>;
  { max(a, b) } -> std::convertible_to<T>;
  T(1.0);
};

/// Lanes from and to memory in sequence, and those before `count`, for a number or a Batch.
template <class T>
MPM_HD T load_lanes(const double* from) {
  if constexpr (std::is_same_v<T, double>)
    return *from;
  else
    return T::load(from);
}
MPM_HD inline void store_lanes(double* to, double value) { *to = value; }
template <class T>
MPM_HD Truth<T> lanes_before(int count) {
  if constexpr (std::is_same_v<T, double>)
    return count > 0;
  else
    return first_lanes<T::lanes>(count);
}

/// How many numbers a T holds.
template <class T>
inline constexpr int lanes_of = 1;

#if !defined(__CUDACC__)
template <int W>
void store_lanes(double* to, Batch<W> value) {
  value.store(to);
}
template <int W>
inline constexpr int lanes_of<Batch<W>> = W;
#endif

}  // namespace mpm
