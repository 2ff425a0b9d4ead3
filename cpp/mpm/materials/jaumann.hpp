#pragma once
// The Jaumann rate for hypoelastic models, second-order accurate; the turning of the old stress is
// exact.
#include "mpm/materials/model.hpp"

namespace mpm {

/// The stress carried to the end of the step by its rotation, and the strain increment seen from
/// there.
template <class T, int D>
struct Corotated {
  Sym<T, D> stress;
  Sym<T, D> strain;  // increment of strain in the frame at the end of the step
};

/// Orthogonal matrix (1 - w/2)^-1 (1 + w/2) of a skew w, in 2D (Hughes & Winget 1980, eq. 14).
template <class T>
MPM_HD Mat<T, 2> cayley(const Mat<T, 2>& w) {
  const T h = T(0.5) * w[0][1];
  const T s = T(1.0) / fma(h, h, T(1.0));
  // cos = (1 - h^2) / (1 + h^2), sin = 2 h / (1 + h^2) with h the tangent of half the angle: a
  // rotation to rounding, whatever the angle.
  const T cosine = fma(-h, h, T(1.0)) * s, sine = T(2.0) * h * s;
  return {{{cosine, sine}, {-sine, cosine}}};
}
/// The same in 3D: 1 + (w + w^2 / 2) / (1 + |a|^2), where a is half the axial vector of w.
template <class T>
MPM_HD Mat<T, 3> cayley(const Mat<T, 3>& w) {
  const T ax = T(0.5) * w[2][1], ay = T(0.5) * w[0][2], az = T(0.5) * w[1][0];
  const T s = T(2.0) / fma(az, az, fma(ay, ay, fma(ax, ax, T(1.0))));
  const T xx = s * ax * ax, yy = s * ay * ay, zz = s * az * az;
  const T xy = s * ax * ay, xz = s * ax * az, yz = s * ay * az;
  const T x = s * ax, y = s * ay, z = s * az;
  return {{{T(1.0) - yy - zz, xy - z, xz + y},
           {xy + z, T(1.0) - xx - zz, yz - x},
           {xz - y, yz + x, T(1.0) - xx - yy}}};
}

/// Eqs. (18)-(19) with the gradient referred to the middle of the step, L_mid = L (1 + L/2)^-1 = L
/// - L^2/2 + O(L^3): a finite rotation then strains nothing to second order, and the trace matches
/// the change of volume. The strain increment acts half a rotation earlier, so it is turned by D +
/// (w D - D w)/2; that makes the update second-order in simple shear, where a strain applied at the
/// end is first-order.
template <class T, int D>
MPM_HD Corotated<T, D> corotate(const StrainIncrement<T, D>& motion, const Sym<T, D>& stress) {
  const Mat<T, D> middle = mid_step(motion.gradient);
  Mat<T, D> spin;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) spin[i][j] = T(0.5) * (middle[i][j] - middle[j][i]);
  const Sym<T, D> strain = symmetric_part(middle);

  Corotated<T, D> r{congruence(cayley(spin), stress), strain};
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      // (w d - d w)/2 for skew w and symmetric d is the symmetric part of w d.
      T wd = spin[i][0] * strain(0, j), dw = spin[j][0] * strain(0, i);
      for (int k = 1; k < D; ++k) {
        wd = fma(spin[i][k], strain(k, j), wd);
        dw = fma(spin[j][k], strain(k, i), dw);
      }
      r.strain(i, j) = fma(T(0.5), wd + dw, strain(i, j));
    }
  return r;
}

}  // namespace mpm
