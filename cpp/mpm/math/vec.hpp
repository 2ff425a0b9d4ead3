#pragma once
// Vectors of D components; D is 2 or 3 throughout.
#include <cmath>
#include <cstddef>

#include "mpm/math/scalar.hpp"

namespace mpm {

template <class T, int D>
struct Vec {
  T c[D];
  MPM_HD T& operator[](int a) { return c[a]; }
  MPM_HD const T& operator[](int a) const { return c[a]; }

  MPM_HD static Vec zero() {
    Vec r;
    for (int a = 0; a < D; ++a) r.c[a] = T(0.0);
    return r;
  }
  MPM_HD friend Vec operator+(const Vec& x, const Vec& y) {
    Vec r;
    for (int a = 0; a < D; ++a) r.c[a] = x.c[a] + y.c[a];
    return r;
  }
  MPM_HD friend Vec operator-(const Vec& x, const Vec& y) {
    Vec r;
    for (int a = 0; a < D; ++a) r.c[a] = x.c[a] - y.c[a];
    return r;
  }
  MPM_HD friend Vec operator*(T s, const Vec& x) {
    Vec r;
    for (int a = 0; a < D; ++a) r.c[a] = s * x.c[a];
    return r;
  }
  MPM_HD Vec& operator+=(const Vec& y) { return *this = *this + y; }
  MPM_HD Vec& operator-=(const Vec& y) { return *this = *this - y; }
};

template <class T, int D>
MPM_HD T dot(const Vec<T, D>& x, const Vec<T, D>& y) {
  T s = x.c[0] * y.c[0];
  for (int a = 1; a < D; ++a) s = fma(x.c[a], y.c[a], s);
  return s;
}

template <int D>
MPM_HD double norm(const Vec<double, D>& x) {
  return std::sqrt(dot(x, x));
}

/// x / |x|, or zero where |x| does not exceed `least`.
template <int D>
MPM_HD Vec<double, D> normalised(const Vec<double, D>& x, double least = 0.0) {
  const double length = norm(x);
  return length > least ? (1.0 / length) * x : Vec<double, D>::zero();
}

}  // namespace mpm
