#pragma once
// Principal values and axes of symmetric tensors, free of branches.
#include "mpm/math/tensor.hpp"

namespace mpm {

/// Principal values, in no order, and their axes: axis[k] belongs to value[k]. In plane strain the
/// third value is zz, and the axes are the two in the plane.
template <class T, int D>
struct Eigen {
  T value[3];
  Vec<T, D> axis[D];

  /// The tensor with the same axes and other values.
  MPM_HD Sym<T, D> with(const T (&values)[3]) const {
    auto r = Sym<T, D>::zero();
    if constexpr (D == 2) r.c[2] = values[2];
    for (int k = 0; k < D; ++k)
      for (int i = 0; i < D; ++i)
        for (int j = i; j < D; ++j) r(i, j) = r(i, j) + values[k] * axis[k][i] * axis[k][j];
    return r;
  }
};

/// One of Jacobi's rotations: makes the component p, q of a symmetric tensor zero, by the smaller
/// of the two angles (Golub & Van Loan 2013, sec. 8.5.2), and turns the axes along. The components
/// must be of order one: `tiny` keeps the angle finite where nothing is to be turned.
template <int p, int q, class T, int D>
MPM_HD void rotate_jacobi(Sym<T, D>& a, Vec<T, D> (&axis)[D]) {
  const T off = a(p, q), half = T(0.5) * (a(q, q) - a(p, p));
  const T size = absolute(half) + sqrt(half * half + off * off + T(tiny));
  // t = tan of the angle, the smaller root of t^2 + 2 t half / off - 1 = 0, written so that nothing
  // cancels.
  const T t = select(half < T(0.0), -off, off) / size;
  const T c = T(1.0) / sqrt(T(1.0) + t * t), s = t * c;
  a(p, p) = a(p, p) - t * off;
  a(q, q) = a(q, q) + t * off;
  a(p, q) = T(0.0);
  if constexpr (D == 3) {
    constexpr int r = 3 - p - q;
    const T rp = a(r, p), rq = a(r, q);
    a(r, p) = c * rp - s * rq;
    a(r, q) = s * rp + c * rq;
  }
  const Vec<T, D> before = axis[p];
  axis[p] = c * before - s * axis[q];
  axis[q] = s * before + c * axis[q];
}

/// Principal values and axes, to some ten roundings of the largest component. In the plane one
/// rotation is exact; in space `sweeps` of three leave less than a rounding, as the tests show.
template <class T, int D>
MPM_HD Eigen<T, D> eigen(const Sym<T, D>& tensor) {
  // A fixed number, not until it settles: lanes would wait for each other, and what one gives would
  // depend on its neighbours.
  constexpr int sweeps = 4;
  // rotate_jacobi wants components of order one; where all are zero this is no division by zero.
  T size(tiny);
  for (int k = 0; k < Sym<T, D>::size; ++k) size = max(size, absolute(tensor.c[k]));
  Sym<T, D> a = (T(1.0) / size) * tensor;
  Eigen<T, D> r;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) r.axis[i][j] = T(i == j ? 1.0 : 0.0);
  if constexpr (D == 2) {
    rotate_jacobi<0, 1>(a, r.axis);
  } else {
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      rotate_jacobi<0, 1>(a, r.axis);
      rotate_jacobi<0, 2>(a, r.axis);
      rotate_jacobi<1, 2>(a, r.axis);
    }
  }
  for (int k = 0; k < 3; ++k) r.value[k] = size * a.c[k];
  return r;
}

/// Three values in falling order, and the way back.
template <class T>
struct Sorted {
  T value[3];
  Truth<T> swapped[3];

  MPM_HD explicit Sorted(const T (&values)[3]) : value{values[0], values[1], values[2]} {
    swapped[0] = put_in_order(value[0], value[1]);
    swapped[1] = put_in_order(value[1], value[2]);
    swapped[2] = put_in_order(value[0], value[1]);
  }
  /// Take values in falling order's places back to the places before.
  MPM_HD void unsort(T (&values)[3]) const {
    swap_where(swapped[2], values[0], values[1]);
    swap_where(swapped[1], values[1], values[2]);
    swap_where(swapped[0], values[0], values[1]);
  }

 private:
  MPM_HD static void swap_where(Truth<T> condition, T& a, T& b) {
    const T before = a;
    a = select(condition, b, a);
    b = select(condition, before, b);
  }
  MPM_HD static Truth<T> put_in_order(T& a, T& b) {
    const Truth<T> wrong = a < b;
    swap_where(wrong, a, b);
    return wrong;
  }
};

}  // namespace mpm
