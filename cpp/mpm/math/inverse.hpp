#pragma once
// The inverse of a small matrix.
#include "mpm/math/tensor.hpp"

namespace mpm {

/// By its adjugate; of a matrix without an inverse numbers that are not finite.
template <class T>
MPM_HD Mat<T, 2> inverse_of(const Mat<T, 2>& a) {
  const T scale = T(1.0) / determinant(a);
  Mat<T, 2> r;
  r[0][0] = scale * a[1][1];
  r[0][1] = -(scale * a[0][1]);
  r[1][0] = -(scale * a[1][0]);
  r[1][1] = scale * a[0][0];
  return r;
}
template <class T>
MPM_HD Mat<T, 3> inverse_of(const Mat<T, 3>& a) {
  const auto minor = [&](int i, int j, int k, int l) {
    return fma(a[i][k], a[j][l], -(a[i][l] * a[j][k]));
  };
  Mat<T, 3> r;
  // Of rows and columns one after another in the cycle 0, 1, 2, cofactors have their signs.
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[j][i] = minor((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
  const T scale = T(1.0) / fma(a[0][0], r[0][0], fma(a[0][1], r[1][0], a[0][2] * r[2][0]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[i][j] = scale * r[i][j];
  return r;
}

/// The square of the largest stretch by a matrix A, or somewhat more: the largest sum of a row of
/// the sizes in A A^T, which is exact along the axes and along their diagonals.
template <class T, int D>
MPM_HD T largest_stretch_squared(const Mat<T, D>& a) {
  T largest(0.0);
  for (int i = 0; i < D; ++i) {
    T row(0.0);
    for (int j = 0; j < D; ++j) {
      T c = a[i][0] * a[j][0];
      for (int k = 1; k < D; ++k) c = fma(a[i][k], a[j][k], c);
      row += absolute(c);
    }
    largest = max(largest, row);
  }
  return largest;
}

}  // namespace mpm
