#pragma once
// Walls on the faces of an optional box. Node indices count from the box's lower corner.
#include "mpm/basis/tile.hpp"

namespace mpm {

/// free: no constraint; slip (symmetry): no motion across the face; fixed: no motion; absorbing:
/// dashpots that let waves pass.
enum class Wall { free, slip, fixed, absorbing };

template <int D>
struct Walls {
  bool exist = false;    // is there a box at all
  Index<D> cells{};      // cells of the box along each axis
  Wall face[D][2] = {};  // [axis][lower, upper]

  bool absorb() const {
    bool any = false;
    for (const auto& faces : face)
      any = any || faces[0] == Wall::absorbing || faces[1] == Wall::absorbing;
    return exist && any;
  }

  /// Bit a is set if a node may not move along axis a. Nodes beyond a fixed face are held like
  /// those on it; those beyond a slip face are images of nodes before it.
  unsigned held(const Index<D>& node) const {
    unsigned axes = 0;
    if (!exist) return axes;
    for (int a = 0; a < D; ++a) {
      for (int side = 0; side < 2; ++side) {
        const int depth = depth_beyond(node, a, side);
        if (depth == 0 && face[a][side] == Wall::slip) axes |= 1u << a;
        if (depth >= 0 && face[a][side] == Wall::fixed) axes |= (1u << D) - 1u;
      }
    }
    return axes;
  }

  /// Bit a is set if a node lies beyond a slip face of axis a, which is a plane of symmetry;
  /// `image` is then where it is mirrored to.
  unsigned mirrored(const Index<D>& node, Index<D>& image) const {
    unsigned axes = 0;
    image = node;
    if (!exist) return axes;
    for (int a = 0; a < D; ++a)
      for (int side = 0; side < 2; ++side) {
        const int depth = depth_beyond(node, a, side);
        if (depth <= 0 || face[a][side] != Wall::slip) continue;
        axes |= 1u << a;
        image[a] += (side == 0 ? 2 : -2) * depth;
      }
    return axes;
  }

 private:
  int depth_beyond(const Index<D>& node, int axis, int side) const {
    return side == 0 ? -node[axis] : node[axis] - cells[axis];
  }
};

}  // namespace mpm
