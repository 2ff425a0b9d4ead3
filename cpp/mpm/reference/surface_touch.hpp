#pragma once
// What contact between surfaces is made of, in the reference step: the height of a point over the
// points of a surface, planes of symmetry, and a touch.
#include <complex>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "mpm/reference/mirrors.hpp"

namespace mpm::reference {

/// |x - y|^2, of complex places too.
template <class T, int D>
T square(const Vec<T, D>& x, const Vec<T, D>& y) {
  T sum(0.0);
  for (int a = 0; a < D; ++a) sum += (x[a] - y[a]) * (x[a] - y[a]);
  return sum;
}
/// What a vector has along a plane of that normal.
template <int D>
Vec<double, D> along(const Vec<double, D>& v, const Vec<double, D>& n) {
  return v - dot(v, n) * n;
}

/// How high the sum S says that a point lies over the points of a surface, (S3).
template <int D>
struct Height {
  static constexpr int n = D == 2 ? 6 : 5;
  static constexpr double m = n + 0.5 * (D - 1), pi = std::numbers::pi;

  double e;  // spacing of points [m]
  double a = second_zero() / (2.0 * pi), R = std::sqrt(1.0 + a * a);
  // Over points that lie evenly, at the height e: the integral of the weights over the plane.
  double disc = D == 2 ? std::sqrt(pi) * std::tgamma(n + 1.0) / std::tgamma(n + 1.5) : pi / (n + 1);
  double S_1 = std::pow(a / R, 2 * n) * std::pow(a, D - 1) * disc;

  /// (1 - |x_q - x_p|^2 / R^2 e^2)_+^n, of the square.
  template <class T>
  T weight(const T& square) const {
    const T t = 1.0 - square / (R * R * e * e);
    if (!(std::real(t) > 0.0)) return T(0.0);
    T power = t;
    for (int k = 1; k < n; ++k) power *= t;
    return power;
  }
  template <class T>
  T zeta(const T& S) const {
    const T square = R * R - a * a * std::pow(S / S_1, 1.0 / m);
    // The tangent of the root at .3, deeper.
    return std::real(square) > 0.09 ? std::sqrt(square) : 0.3 + (square - 0.09) / 0.6;
  }

  /// Of J_m(x), which is x^m times the integral of cos(x sin t) cos(t)^2m over -pi/2 < t < pi/2
  /// and a number (Poisson); by bisection between its first zero and its third.
  static double second_zero() {
    const auto J = [](double x) {
      double sum = 0.0;
      for (int k = 1; k < 400; ++k) {
        const double t = pi * (k / 400.0 - 0.5);
        sum += std::cos(x * std::sin(t)) * std::pow(std::cos(t), 2.0 * m);
      }
      return sum;
    };
    double low = 12.0, high = 15.5;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (std::signbit(J(middle)) == std::signbit(J(low)) ? low : high) = middle;
    }
    return low;
  }
};

/// (sum of S_f^4)^(1/4) of the faces of a body.
template <class T>
T of_all_faces(const std::map<int, T>& sums) {
  T most(0.0), powers(0.0);
  for (const auto& [face, S] : sums)
    if (std::real(S) > std::real(most)) most = S;
  if (sums.size() == 1) return most;
  for (const auto& [face, S] : sums) powers += std::pow(S / most, 4);
  return most * std::pow(powers, 0.25);
}

/// Whom a point touches: a body by its number, or a face of the box as -1 - (2 axis + side).
using Whom = int;
constexpr bool is_wall(Whom whom) { return whom < 0; }
constexpr int axis_of(Whom face) { return (-1 - face) / 2; }
constexpr int side_of(Whom face) { return (-1 - face) % 2; }

/// A point q of the other body that a point p feels, or that the image of p feels.
template <int D>
struct Felt {
  std::size_t q;
  Mirror<D> mirror;       // of p
  double share;           // a_q w_q / S
  Vec<double, D> push{};  // on q [N]
};

/// A point p of a body and whom it overlaps.
template <int D>
struct SurfaceTouch {
  std::size_t body, point;
  Whom whom;
  std::vector<Felt<D>> felt{};
  double z = 0.0, b = 0.0;            // height over its points or over the face, set back by [m]
  double k = 0.0, w = 0.0;            // (S1) [N/m]; (S4) [m]
  Vec<double, D> slope{};             // do/dx of p, backwards: where it is pushed
  Vec<double, D> push{}, rub{};       // on p, at it and at the place of contact [N]
  Vec<double, D> place{};             // of contact [m]
  bool rubs = false, slides = false;  // has friction; at its limit
};

/// The two who touch, the lower number first; a face last.
template <int D>
std::pair<Whom, Whom> pair_of(const SurfaceTouch<D>& t) {
  const auto body = static_cast<Whom>(t.body);
  return is_wall(t.whom) ? std::pair(body, t.whom)
                         : std::pair(std::min(body, t.whom), std::max(body, t.whom));
}

/// What is stored over k: of the force o, which begins softly from o = -w / 2 to w / 2, (S4).
template <class T>
T stored(const T& o, double w) {
  if (std::real(o) >= 0.5 * w) return 0.5 * o * o + w * w / 24.0;
  const T begun = o + 0.5 * w;
  return begun * begun * begun / (6.0 * w);
}

/// What a touch remembers from its beginning on: s of (S2) and w of (S4) [m].
template <int D>
struct SurfaceMemory {
  Vec<double, D> s = Vec<double, D>::zero();
  double w = 0.0;
};

/// Friction and restitution of two bodies, and whether they are bonded.
struct SurfaceLaw {
  double mu = 0.0, restitution = 1.0;
  bool bonded = false;
};

}  // namespace mpm::reference
