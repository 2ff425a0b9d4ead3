#pragma once
// What a number must offer for a kernel or a model: the same source serves double (the oracle) and
// SIMD lanes.
#include <algorithm>
#include <cmath>
#include <concepts>

#include "mpm/math/batch.hpp"

namespace mpm {

inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double sqrt(double a) { return std::sqrt(a); }
inline double log(double a) { return std::log(a); }
inline double sum(double a) { return a; }
inline double largest(double a) { return a; }
inline bool any(bool a) { return a; }

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

}  // namespace mpm
