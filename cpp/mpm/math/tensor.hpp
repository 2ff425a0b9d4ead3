#pragma once
// Second-order tensors. In 2D the motion is plane strain: a symmetric tensor keeps its zz component
// and has no yz, xz.
#include "mpm/math/vec.hpp"

namespace mpm {

/// A D x D matrix, row by row: the velocity gradient times the time step, for instance.
template <class T, int D>
struct Mat {
  T c[D][D];
  MPM_HD T* operator[](int i) { return c[i]; }
  MPM_HD const T* operator[](int i) const { return c[i]; }
};

template <class T, int D>
MPM_HD Mat<T, D> operator*(const Mat<T, D>& a, const Mat<T, D>& b) {
  Mat<T, D> r;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      T s = a[i][0] * b[0][j];
      for (int k = 1; k < D; ++k) s = fma(a[i][k], b[k][j], s);
      r[i][j] = s;
    }
  return r;
}

template <class T>
MPM_HD T determinant(const Mat<T, 2>& a) {
  return fma(a[0][0], a[1][1], -(a[0][1] * a[1][0]));
}
template <class T>
MPM_HD T determinant(const Mat<T, 3>& a) {
  const auto minor = [&](int i, int j) { return fma(a[1][i], a[2][j], -(a[1][j] * a[2][i])); };
  return fma(a[0][0], minor(1, 2), fma(-a[0][1], minor(0, 2), a[0][2] * minor(0, 1)));
}

/// A symmetric tensor; components xx yy zz yz xz xy in 3D, xx yy zz xy in 2D.
template <class T, int D>
struct Sym {
  static constexpr int size = D == 3 ? 6 : 4;
  T c[size];

  MPM_HD static constexpr int index(int i, int j) {
    if (i == j) return i;
    return D == 2 ? 3 : 6 - i - j;  // (1,2) -> 3, (0,2) -> 4, (0,1) -> 5
  }
  MPM_HD T& operator()(int i, int j) { return c[index(i, j)]; }
  MPM_HD const T& operator()(int i, int j) const { return c[index(i, j)]; }

  MPM_HD static Sym zero() { return isotropic(T(0.0)); }
  MPM_HD static Sym isotropic(T s) {
    Sym r;
    for (int k = 0; k < size; ++k) r.c[k] = k < 3 ? s : T(0.0);
    return r;
  }
  MPM_HD friend Sym operator+(const Sym& x, const Sym& y) {
    Sym r;
    for (int k = 0; k < size; ++k) r.c[k] = x.c[k] + y.c[k];
    return r;
  }
  MPM_HD friend Sym operator-(const Sym& x, const Sym& y) {
    Sym r;
    for (int k = 0; k < size; ++k) r.c[k] = x.c[k] - y.c[k];
    return r;
  }
  MPM_HD friend Sym operator*(T s, const Sym& x) {
    Sym r;
    for (int k = 0; k < size; ++k) r.c[k] = s * x.c[k];
    return r;
  }
};

template <class T, int D>
MPM_HD T trace(const Sym<T, D>& a) {
  return a.c[0] + a.c[1] + a.c[2];
}

/// a : b, every shear component counted twice.
template <class T, int D>
MPM_HD T inner(const Sym<T, D>& a, const Sym<T, D>& b) {
  const T normal = fma(a.c[2], b.c[2], fma(a.c[1], b.c[1], a.c[0] * b.c[0]));
  T shear = a.c[3] * b.c[3];
  for (int k = 4; k < Sym<T, D>::size; ++k) shear = fma(a.c[k], b.c[k], shear);
  return fma(T(2.0), shear, normal);
}

/// The symmetric part of a gradient; zz is zero in plane strain.
template <class T, int D>
MPM_HD Sym<T, D> symmetric_part(const Mat<T, D>& g) {
  auto r = Sym<T, D>::zero();
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) r(i, j) = i == j ? g[i][i] : T(0.5) * (g[i][j] + g[j][i]);
  return r;
}

/// f s f^T; the zz component is unchanged in plane strain.
template <class T, int D>
MPM_HD Sym<T, D> congruence(const Mat<T, D>& f, const Sym<T, D>& s) {
  Mat<T, D> fs;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      T t = f[i][0] * s(0, j);
      for (int k = 1; k < D; ++k) t = fma(f[i][k], s(k, j), t);
      fs[i][j] = t;
    }
  Sym<T, D> r = s;
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      T t = fs[i][0] * f[j][0];
      for (int k = 1; k < D; ++k) t = fma(fs[i][k], f[j][k], t);
      r(i, j) = t;
    }
  return r;
}

/// Von Mises equivalent of a stress: sqrt(3/2 s:s), s the deviator.
template <class T, int D>
MPM_HD T von_mises(const Sym<T, D>& stress) {
  const Sym<T, D> s = stress - Sym<T, D>::isotropic(trace(stress) * T(1.0 / 3.0));
  return sqrt(T(1.5) * inner(s, s));
}

}  // namespace mpm
