#pragma once
// Walls on the faces of an optional box. Node indices count from the box's lower corner.
#include <optional>

#include "mpm/catalogue/words.hpp"
#include "mpm/layout/tile.hpp"
#include "mpm/math/host_device.hpp"

namespace mpm {

/// What a face of the box does.
enum class Wall { free, slip, fixed, absorbing, contact };
template <>
inline constexpr auto words<Wall> = std::to_array<Word<Wall>>(
    {{"free", Wall::free, "nothing"},
     {"slip", Wall::slip, "no motion across the face", "symmetry"},
     {"fixed", Wall::fixed, "no motion"},
     {"absorbing", Wall::absorbing, "dashpots that let waves pass"},
     {"contact", Wall::contact, "pushes back what touches it, with friction, and lets it part"}});

/// The node before the walls whose image a node beyond them is: what is given to one is the
/// other's, and they move together, vectors with the components `turned`, a bit each.
template <int D>
struct WallImage {
  Index<D> node;
  unsigned turned;

  /// A component of a vector, as the image has it.
  MPM_HD double component(double value, int axis) const {
    return turned >> axis & 1u ? -value : value;
  }
};

template <int D>
struct Walls {
  bool exist = false;          // is there a box at all
  Index<D> cells{};            // cells of the box along each axis
  Wall face[D][2] = {};        // [axis][lower, upper]
  double friction[D][2] = {};  // of faces that touch, Coulomb's coefficient
  bool odd_at_fixed = false;   // (BasisModel)

  /// Coulomb's coefficient of a face on which nothing slides.
  static constexpr double rough = 1e6;

  /// Does a face hold what lies on it: as a plane of symmetry, or fixed?
  MPM_HD static bool holds(Wall wall) { return wall == Wall::slip || wall == Wall::fixed; }
  /// Do all such faces hold a body, by the bits 2 axis + side of those that do?
  bool all_hold(unsigned faces) const {
    bool all = true;
    for (int a = 0; a < D; ++a)
      for (int side = 0; side < 2; ++side)
        all = all && (!holds(face[a][side]) || (faces >> (2 * a + side) & 1u) != 0);
    return all;
  }
  /// The walls of a body that some of those faces do not hold (bits 2 axis + side are of those that
  /// do): it does not lie on these, which push back what comes to them, on a fixed one without
  /// sliding.
  Walls as_held_by(unsigned faces) const {
    Walls walls = *this;
    for (int a = 0; a < D; ++a)
      for (int side = 0; side < 2; ++side) {
        if (!holds(face[a][side]) || (faces >> (2 * a + side) & 1u)) continue;
        walls.friction[a][side] = face[a][side] == Wall::fixed ? rough : 0.0;
        walls.face[a][side] = Wall::contact;
      }
    return walls;
  }

  MPM_HD bool absorb() const { return any(Wall::absorbing); }
  MPM_HD bool touch() const { return any(Wall::contact); }

  /// Is a body's surface looked at as if it went on behind it, mirrored?
  MPM_HD static bool goes_on(Wall wall) { return wall != Wall::free && wall != Wall::contact; }

  /// By how many cells a node lies beyond a face, < 0 where it lies before it.
  MPM_HD int depth_beyond(const Index<D>& node, int axis, int side) const {
    return side == 0 ? -node[axis] : node[axis] - cells[axis];
  }

  /// Bit a is set if a node may not move along axis a. Nodes beyond a fixed face are held like
  /// those on it, or have images. On a slip face the normal velocity is 0 by symmetry, as for a
  /// turned component v = -v.
  MPM_HD unsigned constrained_axes(const Index<D>& node) const {
    unsigned axes = 0;
    if (!exist) return axes;
    for (int a = 0; a < D; ++a) {
      for (int side = 0; side < 2; ++side) {
        if (!holds(face[a][side], depth_beyond(node, a, side))) continue;
        axes |= axes_of(face[a][side], a);
      }
    }
    return axes;
  }

  /// The faces, as bits 2 axis + side, that hold a component of what a node has.
  MPM_HD unsigned faces_holding(const Index<D>& node, int component) const {
    return faces_where(node, [&](Wall wall, int axis, int depth) {
      return holds(wall, depth) && (axes_of(wall, axis) >> component & 1u) != 0;
    });
  }
  /// Those that turn it, of a node beyond them with an image.
  MPM_HD unsigned faces_turning(const Index<D>& node, int component) const {
    return faces_where(node, [&](Wall wall, int axis, int depth) {
      return mirrors(wall, depth) && (axes_of(wall, axis) >> component & 1u) != 0;
    });
  }
  /// Those of which it carries dashpots.
  MPM_HD unsigned faces_absorbing(const Index<D>& node) const {
    return faces_where(
        node, [](Wall wall, int, int depth) { return wall == Wall::absorbing && depth == 0; });
  }

  /// Lies a node from `before` this one to `after` it, along any axis, on a fixed face or beyond?
  MPM_HD bool fixes_near(const Index<D>& node, int before, int after) const {
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
  MPM_HD std::optional<WallImage<D>> image(const Index<D>& node) const {
    if (!exist) return {};
    WallImage<D> image{node, 0};
    bool beyond = false;
    for (int a = 0; a < D; ++a)
      for (int side = 0; side < 2; ++side) {
        const int depth = depth_beyond(node, a, side);
        if (!mirrors(face[a][side], depth)) continue;
        beyond = true;
        image.turned ^= axes_of(face[a][side], a);
        image.node[static_cast<std::size_t>(a)] += (side == 0 ? 2 : -2) * depth;
      }
    if (!beyond) return {};
    return image;
  }

 private:
  MPM_HD bool any(Wall kind) const {
    bool found = false;
    for (const auto& faces : face) found = found || faces[0] == kind || faces[1] == kind;
    return exist && found;
  }
  /// The axes along which a wall holds or turns what nodes have: a slip wall its normal.
  MPM_HD static unsigned axes_of(Wall wall, int axis) {
    return wall == Wall::slip ? 1u << axis : (1u << D) - 1u;
  }
  MPM_HD bool holds(Wall wall, int depth) const {
    if (wall == Wall::slip) return depth == 0;
    return wall == Wall::fixed && (depth == 0 || (depth > 0 && !odd_at_fixed));
  }
  MPM_HD bool mirrors(Wall wall, int depth) const {
    return depth > 0 && (wall == Wall::slip || (wall == Wall::fixed && odd_at_fixed));
  }
  template <class F>
  MPM_HD unsigned faces_where(const Index<D>& node, F&& f) const {
    unsigned faces = 0;
    for (int a = 0; exist && a < D; ++a)
      for (int side = 0; side < 2; ++side)
        if (f(face[a][side], a, depth_beyond(node, a, side))) faces |= 1u << (2 * a + side);
    return faces;
  }
};

}  // namespace mpm
