#pragma once
// The choice of shape functions.
#include <algorithm>

#include "mpm/basis/gimp.hpp"
#include "mpm/basis/linear.hpp"

namespace mpm {

/// linear: the paper's, and the fastest. gimp: smooth where particles cross cells, dearer.
enum class Basis { linear, gimp };

/// Nodes before a cell's own that its particles reach; behind it they reach one.
constexpr int margin_of(Basis basis) { return basis == Basis::gimp ? 1 : 0; }

/// Place of a cell's own node in the cell along each axis: in its corner, or with GIMP its middle.
constexpr double node_in_cell(Basis basis) { return basis == Basis::gimp ? 0.5 : 0.0; }

/// Position within the cell, in [1e-12, 1 - 1e-12], from the position in cells and the cell's
/// coordinate. A particle exactly on a cell's face would give force to nodes to which it gives no
/// mass; it is held 1e-12 cells away.
template <class T>
T local_coordinate(T cells, double cell) {
  constexpr double from_face = 1e-12;
  return min(max(cells - T(cell), T(from_face)), T(1.0 - from_face));
}

/// Half the edge of a GIMP particle [cells] from its edge at the start [cells]; at most half a
/// cell.
inline double gimp_half(double edge) { return std::min(0.5 * edge, 0.5); }

/// Distance along an axis at which a particle's shape function ends [cells].
inline double support(Basis basis, double edge) {
  return 1.0 + (basis == Basis::gimp ? gimp_half(edge) : 0.0);
}

/// f(basis object) for the chosen basis; `edge` is the particles' edge at the start [cells].
template <int D, class F>
void with_basis(Basis basis, const BlockShape<D>& shape, double edge, F&& f) {
  if (basis == Basis::linear) {
    f(Linear<D>{shape});
  } else {
    f(Gimp<D>{shape, gimp_half(edge)});
  }
}

}  // namespace mpm
