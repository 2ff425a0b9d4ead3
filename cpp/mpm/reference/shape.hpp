#pragma once
// Shape functions along one axis as their papers write them: of the distance d of a particle from a
// node, in cells.
#include <cmath>

namespace mpm::reference {

/// N and dN/dd.
struct ShapeValue {
  double N, dN;
};

/// The hat, the paper's shape function.
inline ShapeValue linear(double d) {
  const double u = std::abs(d), sign = d < 0.0 ? -1.0 : 1.0;
  if (u >= 1.0) return {0.0, 0.0};
  return {1.0 - u, -sign};
}

/// Uniform GIMP of particles with edges 2 l (Bardenhagen & Kober 2004, the S of their eq. 37).
inline ShapeValue gimp(double d, double l) {
  const double u = std::abs(d), sign = d < 0.0 ? -1.0 : 1.0;
  if (u < l) return {1.0 - (u * u + l * l) / (2.0 * l), -sign * u / l};
  if (u < 1.0 - l) return {1.0 - u, -sign};
  if (u >= 1.0 + l) return {0.0, 0.0};
  const double rest = 1.0 + l - u;
  return {rest * rest / (4.0 * l), -sign * rest / (2.0 * l)};
}

/// The quadratic B-spline with knots midway between the nodes (Steffen, Kirby & Berzins 2008).
inline ShapeValue quadratic(double d) {
  const double u = std::abs(d), sign = d < 0.0 ? -1.0 : 1.0;
  if (u < 0.5) return {0.75 - u * u, -2.0 * sign * u};
  if (u >= 1.5) return {0.0, 0.0};
  return {0.5 * (1.5 - u) * (1.5 - u), -sign * (1.5 - u)};
}

}  // namespace mpm::reference
