#pragma once
// An optional region outside which particles take no part any more.
#include <limits>

#include "mpm/math/vec.hpp"

namespace mpm {

template <int D>
struct OutflowBox {
  bool exist = false;
  Vec<double, D> lower, upper;  // corners [m]; infinite where there is no limit

  MPM_HD bool holds(const Vec<double, D>& x) const { return holds(x, x); }
  /// Whether a box lies in the region as a whole.
  MPM_HD bool holds(const Vec<double, D>& low, const Vec<double, D>& high) const {
    bool inside = true;
    for (int a = 0; a < D; ++a) inside = inside && low[a] >= lower[a] && high[a] <= upper[a];
    return inside;
  }
};

}  // namespace mpm
