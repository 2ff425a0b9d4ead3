#pragma once
#include <cmath>

#include "mpm/basis/axis_weights.hpp"

namespace mpm {

/// The quadratic B-spline with knots midway between the nodes, where cells are centred at the
/// nodes: with u = xi - 1/2 the distance from the cell's own node, (1/2 -+ u)^2 / 2 at its
/// neighbours and 3/4 - u^2 between them. Its derivative is continuous. It is GIMP with l = 1/2,
/// the hat averaged over a cell: there A = (1/2 - |u|)^2 / 2, so that max(u, 0) + A = (1/2 + u)^2 /
/// 2.
struct QuadraticBSpline {
  static constexpr std::string_view name = "quadratic_bspline";
  static constexpr std::string_view doc =
      "quadratic B-spline: its gradient is continuous where particles cross cells";
  static constexpr std::string_view source = "Steffen, Kirby & Berzins 2008, eq. 15";

  static constexpr int nodes = 3, before = 1;
  static constexpr double own_node = 0.5;
  // At a node on the wall (u = 0) its neighbours still have 1/8. Were the one beyond held, v at the
  // wall would be 1/8 of that of the one before it; turned, the two cancel.
  static constexpr bool odd_at_fixed_walls = true;
  // (1 + u)^2 (1/2 - u)^2 / 2 + u^2 (3/4 - u^2) + (1 - u)^2 (1/2 + u)^2 / 2 (Jiang et al. 2015).
  static constexpr double second_moment = 0.25;
  static constexpr double second_derivative[nodes] = {1.0, -2.0, 1.0};

  MPM_HD explicit QuadraticBSpline(double /*edge*/) {}
  MPM_HD double half_width() const { return 0.5; }  // it is the hat averaged over a cell

  /// See BasisModel: r (2 a - r) / 2 with a = |away| and r what is left, by steps of 2 a, of the
  /// way from the particle back to the knot. With it N at a flat face is the sum of 2 a dN over the
  /// particles behind, 2 a apart: it is d^2 / 2 but where a particle's part of the body has a knot
  /// in it, which its one point does not see.
  static double second_order(double xi, double away, double /*part*/) {
    const double a = std::abs(away);
    const double back = away > 0.0 ? xi : 1.0 - xi;
    const double r = back - 2.0 * a * std::floor(back / (2.0 * a));
    return 0.5 * r * (2.0 * a - r);
  }

  template <class T>
  MPM_HD AxisWeights<T, nodes> along(T xi) const {
    // xi = 1/2 + u and rest = 1/2 - u.
    const T rest = T(1.0) - xi, u = xi - T(0.5);
    return {{T(0.5) * rest * rest, fma(-u, u, T(0.75)), T(0.5) * xi * xi},
            {-rest, T(-2.0) * u, xi}};
  }
};

}  // namespace mpm
