#pragma once
#include "mpm/basis/axis_weights.hpp"

namespace mpm {

/// The hat: 1 - xi and xi at the two ends of the cell.
struct Linear {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view doc =
      "the paper's shape functions, and the fastest; noisy where particles cross cells";
  static constexpr std::string_view source = "Sulsky, Chen & Schreyer 1994";

  // Its gradient jumps where particles cross cells, and with it eq. (9): the noise that GIMP was
  // made against (Bardenhagen & Kober 2004).
  static constexpr int nodes = 2, before = 0;
  static constexpr double own_node = 0.0;
  static constexpr bool odd_at_fixed_walls = false;
  static constexpr double second_moment = 0.0;  // xi (1 - xi): none at a node

  MPM_HD explicit Linear(double /*edge*/) {}
  MPM_HD double half_width() const { return 0.0; }

  template <class T>
  MPM_HD AxisWeights<T, nodes> along(T xi) const {
    return {{T(1.0) - xi, xi}, {T(-1.0), T(1.0)}};
  }
};

}  // namespace mpm
