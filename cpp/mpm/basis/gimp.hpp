#pragma once
#include "mpm/basis/axis_weights.hpp"

namespace mpm {

/// Uniform GIMP: the hat averaged over the particle, a box of edges 2 l that stay as they are at
/// the start, 2 l at most one cell. Cells are centred at the nodes, so that all particles of a cell
/// reach the same three. With u the distance from the nearest, a = max(l - |u|, 0) and A = a^2 / (4
/// l), all lengths in cells, that node and its two neighbours get
///   1 - |u| - 2 A,  max(-u, 0) + A below,  max(u, 0) + A above:
/// the hat plus second differences where the box reaches over the node.
struct Gimp {
  static constexpr std::string_view name = "gimp";
  static constexpr std::string_view doc =
      "uniform GIMP: smooth where particles cross cells, twice as dear as the linear basis";
  static constexpr std::string_view source = "Bardenhagen & Kober 2004, eqs. for S_ip";

  static constexpr int nodes = 3, before = 1;
  static constexpr double own_node = 0.5;
  static constexpr bool odd_at_fixed_walls = false;

  double l;  // half the particle's edge [cells], at most 1/2

  MPM_HD explicit Gimp(double edge) : l(min(0.5 * edge, 0.5)) {}
  MPM_HD double half_width() const { return l; }

  template <class T>
  MPM_HD AxisWeights<T, nodes> along(T xi) const {
    const T u = xi - T(0.5);
    const auto is_above = u >= T(0.0);
    const T above = max(u, T(0.0)), below = max(-u, T(0.0));
    const T a = max(T(l) - (below + above), T(0.0)), A = T(0.25 / l) * a * a;
    const T dA = select(is_above, T(-0.5 / l), T(0.5 / l)) * a;
    const T low = select(is_above, T(0.0), T(-1.0)) + dA;
    const T high = select(is_above, T(1.0), T(0.0)) + dA;
    return {{below + A, fma(T(-2.0), A, T(1.0) - (below + above)), above + A},
            {low, -(low + high), high}};
  }
};

}  // namespace mpm
