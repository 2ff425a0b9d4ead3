#pragma once
// Planes of symmetry in the reference step: walls that are slip or fixed.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// What walls that are planes of symmetry make of a place: its image, along some axes or none.
template <int D>
struct Mirror {
  Vec<double, D> sign, twice;  // 1 or -1; where the wall is, twice [m]

  template <class T>
  Vec<T, D> place(Vec<T, D> x) const {
    for (int a = 0; a < D; ++a) x[a] = sign[a] * x[a] + twice[a];
    return x;
  }
  Vec<double, D> vector(Vec<double, D> v) const {
    for (int a = 0; a < D; ++a) v[a] *= sign[a];
    return v;
  }
};

/// That which leaves a place where it is, and those of walls that are slip or fixed, of edges and
/// corners too.
template <int D, class F>
void for_each_mirror(double h, const Walls<D>& walls, F&& f) {
  Index<D> low, high;
  low.fill(-1), high.fill(1);
  for_each_index<D>(low, high, [&](const Index<D>& side) {
    Mirror<D> mirror;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      mirror.sign[a] = side[k] == 0 ? 1.0 : -1.0;
      mirror.twice[a] = side[k] > 0 ? 2.0 * h * walls.cells[k] : 0.0;
      if (side[k] == 0) continue;
      if (!walls.exist || !Walls<D>::holds(walls.face[k][side[k] < 0 ? 0 : 1])) return;
    }
    f(mirror);
  });
}

}  // namespace mpm::reference
