#pragma once
#include <algorithm>
#include <cmath>

#include "mpm/basis/axis_weights.hpp"

namespace mpm {

/// Uniform GIMP: the hat averaged over the particle, a box of edges 2 l that stay as they are at
/// the start, 2 l at most one cell. Cells are centred at the nodes, so that all particles of a cell
/// reach the same three. With u the distance from the nearest, a = max(l - |u|, 0) and A = a^2 / (4
/// l), all lengths in cells, that node and its two neighbours get
///   1 - |u| - 2 A,  max(-u, 0) + A below,  max(u, 0) + A above:
/// the hat plus second differences where the box reaches over the node. For the mean of |s| over u
/// - l <= s <= u + l is |u| + 2 A, and the hat is 1 - |s| at the node, max(s, 0) above and max(-s,
/// 0) below. The three sum to 1 and their first moment is u: mass is kept, and a linear field is
/// read as it is.
struct Gimp {
  static constexpr std::string_view name = "gimp";
  static constexpr std::string_view doc =
      "uniform GIMP: smooth where particles cross cells, twice as dear as the linear basis";
  static constexpr std::string_view source = "Bardenhagen & Kober 2004, eqs. for S_ip";

  static constexpr int nodes = 3, before = 1;
  static constexpr double own_node = 0.5;
  static constexpr bool odd_at_fixed_walls = false;
  static constexpr double second_moment = 0.0;  // |u| + 2 A - u^2 is another at each place
  static constexpr double second_derivative[nodes] = {1.0, -2.0, 1.0};  // differences

  double l;  // half the particle's edge [cells], at most 1/2

  // No more than half a cell: a wider box would reach a fourth node, which blocks do not hold.
  MPM_HD explicit Gimp(double edge) : l(min(0.5 * edge, 0.5)) {}
  MPM_HD double half_width() const { return l; }

  /// See BasisModel: with it N of the outermost node at a flat face is the sum of 2 a dN, a =
  /// |away|, over the particles behind, 2 a apart: with boxes 2 a wide the hat at the face. Behind
  /// a face that lies askew there are no such rows: b counts by `part`.
  double second_order(double xi, double away, double part) const {
    const double a = std::abs(away), s = away > 0.0 ? xi - 0.5 : 0.5 - xi;
    const auto slope = [&](double at) { return std::clamp(0.5 / l * (at + l), 0.0, 1.0); };
    double N = 0.0;
    const int rows = static_cast<int>(std::ceil((s + l) / (2.0 * a)));
    for (int k = 0; k < rows; ++k) N += 2.0 * a * slope(s - 2.0 * a * k);
    const double over = std::max(l - std::abs(s), 0.0);
    return part * (N - (std::max(s, 0.0) + 0.25 / l * over * over) - a * slope(s));
  }

  template <class T>
  MPM_HD AxisWeights<T, nodes> along(T xi) const {
    const T u = xi - T(0.5);
    // By select and max, for the particles in the lanes lie on both sides. At u = 0 both sides give
    // the derivatives -1/2, 0, 1/2.
    const auto is_above = u >= T(0.0);
    const T above = max(u, T(0.0)), below = max(-u, T(0.0));
    const T a = max(T(l) - (below + above), T(0.0)), A = T(0.25 / l) * a * a;
    // a falls by 1 as |u| grows by 1: dA/du = -sign(u) a / (2 l).
    const T dA = select(is_above, T(-0.5 / l), T(0.5 / l)) * a;
    const T low = select(is_above, T(0.0), T(-1.0)) + dA;
    const T high = select(is_above, T(1.0), T(0.0)) + dA;
    // The middle derivative is what makes the sum 0: a body that moves as one is not strained.
    return {{below + A, fma(T(-2.0), A, T(1.0) - (below + above)), above + A},
            {low, -(low + high), high}};
  }
};

}  // namespace mpm
