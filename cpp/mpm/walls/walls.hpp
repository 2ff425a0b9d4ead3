#pragma once
// Walls on the faces of an optional box. Node indices count from the box's lower corner.
#include <optional>

#include "mpm/catalogue/words.hpp"
#include "mpm/layout/tile.hpp"

namespace mpm {

/// What a face of the box does.
enum class Wall { free, slip, fixed, absorbing };
template <>
inline constexpr auto words<Wall> =
    std::to_array<Word<Wall>>({{"free", Wall::free, "nothing"},
                               {"slip", Wall::slip, "no motion across the face", "symmetry"},
                               {"fixed", Wall::fixed, "no motion"},
                               {"absorbing", Wall::absorbing, "dashpots that let waves pass"}});

/// The node before the walls whose image a node beyond them is: what is given to one is the
/// other's, and they move together, vectors with the components `turned`, a bit each.
template <int D>
struct WallImage {
  Index<D> node;
  unsigned turned;

  /// A component of a vector, as the image has it.
  double component(double value, int axis) const { return turned >> axis & 1u ? -value : value; }
};

template <int D>
struct Walls {
  bool exist = false;         // is there a box at all
  Index<D> cells{};           // cells of the box along each axis
  Wall face[D][2] = {};       // [axis][lower, upper]
  bool odd_at_fixed = false;  // (BasisModel)

  bool absorb() const {
    bool any = false;
    for (const auto& faces : face)
      any = any || faces[0] == Wall::absorbing || faces[1] == Wall::absorbing;
    return exist && any;
  }

  /// Bit a is set if a node may not move along axis a. Nodes beyond a fixed face are held like
  /// those on it, or have images. On a slip face the normal velocity is 0 by symmetry, as for a
  /// turned component v = -v.
  unsigned constrained_axes(const Index<D>& node) const {
    unsigned axes = 0;
    if (!exist) return axes;
    for (int a = 0; a < D; ++a) {
      for (int side = 0; side < 2; ++side) {
        const int depth = depth_beyond(node, a, side);
        if (depth == 0 && face[a][side] == Wall::slip) axes |= 1u << a;
        if (face[a][side] == Wall::fixed && (depth == 0 || (depth > 0 && !odd_at_fixed)))
          axes |= all_axes;
      }
    }
    return axes;
  }

  /// Lies a node from `before` this one to `after` it, along any axis, on a fixed face or beyond?
  bool fixes_near(const Index<D>& node, int before, int after) const {
    if (!exist) return false;
    for (int a = 0; a < D; ++a)
      if ((face[a][0] == Wall::fixed && depth_beyond(node, a, 0) >= -before) ||
          (face[a][1] == Wall::fixed && depth_beyond(node, a, 1) >= -after))
        return true;
    return false;
  }

  /// Of a node beyond a slip face, which is a plane of symmetry, or beyond a fixed one if that is
  /// odd: where it is mirrored to, as deep before the face. Beyond two faces, at an edge of the
  /// box, it is mirrored twice; a component that is turned twice is as it was (hence ^=).
  std::optional<WallImage<D>> image(const Index<D>& node) const {
    if (!exist) return {};
    WallImage<D> image{node, 0};
    bool beyond = false;
    for (int a = 0; a < D; ++a)
      for (int side = 0; side < 2; ++side) {
        const int depth = depth_beyond(node, a, side);
        const bool slip = face[a][side] == Wall::slip;
        if (depth <= 0 || !(slip || (odd_at_fixed && face[a][side] == Wall::fixed))) continue;
        beyond = true;
        image.turned ^= slip ? 1u << a : all_axes;
        image.node[static_cast<std::size_t>(a)] += (side == 0 ? 2 : -2) * depth;
      }
    if (!beyond) return {};
    return image;
  }

 private:
  static constexpr unsigned all_axes = (1u << D) - 1u;
  int depth_beyond(const Index<D>& node, int axis, int side) const {
    return side == 0 ? -node[axis] : node[axis] - cells[axis];
  }
};

}  // namespace mpm
