#pragma once
// Walls on the faces of an optional box. Node indices count from the box's lower corner.
#include "mpm/basis/tile.hpp"

namespace mpm {

/// free: no constraint; slip (symmetry): no motion across the face; fixed: no motion.
enum class Wall { free, slip, fixed };

template <int D>
struct Walls {
  bool exist = false;    // is there a box at all
  Index<D> cells{};      // cells of the box along each axis
  Wall face[D][2] = {};  // [axis][lower, upper]

  /// Bit a is set if a node may not move along axis a. Nodes beyond a face are held like those on
  /// it.
  unsigned held(const Index<D>& node) const {
    unsigned axes = 0;
    if (!exist) return axes;
    for (int a = 0; a < D; ++a) {
      for (int side = 0; side < 2; ++side) {
        const bool beyond = side == 0 ? node[a] <= 0 : node[a] >= cells[a];
        if (!beyond || face[a][side] == Wall::free) continue;
        axes |= face[a][side] == Wall::fixed ? (1u << D) - 1u : 1u << a;
      }
    }
    return axes;
  }
};

}  // namespace mpm
