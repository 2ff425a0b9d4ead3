#pragma once
// How deep a point p lies in the surface of another body, after the sum of decision 0054, by the
// body's contact points q of areas A_q, e / 2 under the surface and e apart, e / 2 in 2D:
//   S_f = sum_q a_q w_q of the points of a face, w_q = (1 - |x_q - x_p|^2 / (R e)^2)^n,
//   S = (sum_f S_f^4)^(1/4),  a_q = A_q / e^(D - 1),
//   zeta = z(R^2 - a^2 (S / S_1)^(1 / m)),  o = e - b - e zeta,                              (S3)
//   z(s) = sqrt(s) from .3^2 on, and its tangent there below,
// with a^2 = R^2 - 1, m = n + (D - 1) / 2, and S_1 the sum at the height of e over points all
// around. The forces follow from the energy k o^2 / 2: on q - k o do/dx_q, on p the sum of their
// opposites. Where points lie closer than drawn the root ends before the layers of points meet, and
// would be steep there.
//
// The longest waves that a lattice of points has in S vanish at zeros of the Bessel function J_m at
// 2 pi a. The second is taken here, and not the first as there: points of a sphere are no lattice,
// and what they leave falls with a^-(m + 1/2).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "mpm/math/double_math.hpp"
#include "mpm/surfaces/surfaces.hpp"

namespace mpm {

/// Rounds to multiples of 2^-44, of which sums below 2^8 are exact: their order does not matter,
/// nor how many lists hold that are not felt.
template <class T>
T in_steps(T share) {
  const T far(1.5 * 256.0);  // 2^52 steps are 2^8
  return (share + far) - far;
}

/// The sum S of the faces of a body, each by itself: the largest, but smooth where two are as
/// large.
///   S = (sum_f S_f^4)^(1/4),   dS/dS_f = (S_f / S)^3
inline double sum_of_faces(std::span<const double> sums) {
  if (sums.size() == 1) return sums.front();
  double most = 0.0, powers = 0.0;
  for (const double sum : sums) most = std::max(most, sum);
  if (!(most > 0.0)) return 0.0;
  for (const double sum : sums) {
    const double square = (sum / most) * (sum / most);
    powers += in_steps(square * square);
  }
  return powers > 1.0 ? most * std::sqrt(std::sqrt(powers)) : most;
}
inline double share_of_face(double of_face, double sum) {
  const double part = of_face / sum;
  return part * part * part;
}

template <int D>
class SurfacePoint {
 public:
  static constexpr int n = D == 2 ? 6 : 5;
  static constexpr double reach = D == 2 ? 2.4725 : 2.3829;  // not less than R

  /// No surface is felt whose nearest point is farther off [spacings]: springs begin up to 1.4
  /// above the points, and in 3D these may lie 2^-1/2 aside.
  static constexpr double farthest = 1.6;

  explicit SurfacePoint(double sum) {
    const double share = a2 * std::pow(sum / at_edge(), 1.0 / m);
    const double square = reach_squared - share, root = std::sqrt(std::max(square, deep * deep));
    zeta = root + std::min(square - deep * deep, 0.0) / (2.0 * deep);
    by_sum = -share / (2.0 * root * m * sum);
  }
  double zeta, by_sum;  // and its derivative with respect to S

  /// What a point of the surface at that squared distance adds to the sum, times e^(D - 1).
  template <class T>
  static T weight(T square, double spacing) {
    const T y = max(T(1.0) - T(1.0 / (reach_squared * spacing * spacing)) * square, T(0.0));
    return power_of<n>(y);
  }
  /// d w / d x_q over x_q - x_p.
  static double slope(double square, double spacing) {
    const double scale = 1.0 / (reach_squared * spacing * spacing), y = 1.0 - square * scale;
    return y > 0.0 ? -2.0 * n * scale * power_of<n - 1>(y) : 0.0;
  }
  /// The sum at a height of so many spacings.
  static double sum_at(double height) {
    return at_edge() * std::pow(std::max(reach_squared - height * height, 0.0) / a2, m);
  }

 private:
  static constexpr double zero = D == 2 ? 14.207392458842 : 13.589290170541;  // of J_m, the second
  static constexpr double a = zero / (2.0 * std::numbers::pi), a2 = a * a;
  static constexpr double reach_squared = 1.0 + a2, m = n + 0.5 * (D - 1);  // R^2
  static_assert(reach * reach >= reach_squared && reach * reach < 1.001 * reach_squared);
  static constexpr double deep = 0.3;  // zeta, from which on it follows the tangent

  template <int exponent, class T>
  static constexpr T power_of(T x) {
    T r = x;
    for (int k = 1; k < exponent; ++k) r *= x;
    return r;
  }
  /// S_1: the integral of (1 - u^2)^n, |u| < 1, over lengths or areas, times (a / R)^2n a^(D - 1).
  static constexpr double at_edge() {
    return power_of<n>(a2 / reach_squared) *
           (D == 2 ? 2048.0 / 3003.0 * a : std::numbers::pi / 6.0 * a2);
  }
};

}  // namespace mpm
