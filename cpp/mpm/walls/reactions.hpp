#pragma once
// What walls give to the bodies: the reactions of the nodes that they hold, and what moving a
// vector from a node beyond them to its image does to it and to its moment.
//
// Particles give a node g beyond a wall f_g, and get its increment dv_g, which is that of its image
// turned, R dv_i. So what acts on it beside f_g is m_g dv_g / dt - f_g - m_g g, at x_g. The image
// has the mass m_i + m_g, and f_i + R f_g: what acts on it beside f_i is the rest, at x_i. Both
// together are x_i x R s - x_g x s for s = f_g + m_g g - m_g dv_g / dt, and the forces R s - s; the
// first of s is at hand when forces are folded, the others when nodes have been advanced.
#include <type_traits>

#include "mpm/rigid/prescribed_motion.hpp"
#include "mpm/walls/face_impulses.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {

/// A node of a patch, by its index from the tile's first or by its number, from the box's corner.
template <int D>
Index<D> index_of(const TileGrid<D>& grid, const Patch<D>& patch,
                  std::type_identity_t<Index<D>> node) {
  const Index<D> first = grid.first_cell(patch.tile);
  for (std::size_t a = 0; a < D; ++a) node[a] += first[a];
  return node;
}
template <int D>
Index<D> index_of(const TileGrid<D>& grid, const Patch<D>& patch, int node) {
  return index_of(grid, patch, patch.shape.index(node));
}
/// Its place [m].
template <int D, class Node>
Vector3 place_of(const TileGrid<D>& grid, const Patch<D>& patch, const Node& node) {
  return in_space<D>(grid.position_of(index_of(grid, patch, node)));
}

/// What walls give to the bodies in a step: the angular impulse about the origin [N m s], and the
/// impulses of the faces.
template <int D>
struct Reaction {
  Vector3& moment;
  FaceImpulses<D>& faces;

  /// Of the faces `of_component(axis)`, as bits, together, at a place.
  template <class F>
  void add(const Vector3& place, const Vec<double, D>& impulse, F&& of_component) const {
    moment += cross(place, in_space<D>(impulse));
    for (int a = 0; a < D; ++a)
      if (impulse[a] != 0.0) faces.add(of_component(a), a, impulse[a]);
  }
};
/// Of a patch at a wall; its moment goes to a sum of the angular ledger.
template <int D>
Reaction<D> reaction_of(Domain<D>& domain, std::size_t p, Vector3 AngularImpulses::* sum) {
  return {domain.sums[p].angular.*sum, domain.face_parts[p]};
}

/// Sum of x_i x R s - x_g x s over the nodes beyond walls, and of R s - s: s = vector(node), an
/// impulse [N s].
template <int D, class F>
void add_folding(const TileGrid<D>& grid, const Patch<D>& patch, const Reaction<D>& to,
                 F&& vector) {
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    const Vec<double, D> s = vector(node);
    Vec<double, D> of_image;
    for (int a = 0; a < D; ++a) of_image[a] = turned.component(s[a], a);
    to.moment += cross(place_of(grid, patch, image), in_space<D>(of_image)) -
                 cross(place_of(grid, patch, node), in_space<D>(s));
    const Index<D> place = index_of(grid, patch, node);
    for (int a = 0; a < D; ++a)
      if (of_image[a] != s[a])
        to.faces.add(grid.walls_of(patch.body).faces_turning(place, a), a, of_image[a] - s[a]);
  });
}

/// The same of the nodes that walls hold, with the components of the impulse vector(node) along the
/// axes that they hold; each node once, by `own`, which is 0 beyond walls with images.
template <int D, class F>
void add_holding(const TileGrid<D>& grid, const Patch<D>& patch, const double* own,
                 const Reaction<D>& to, F&& vector) {
  for_each_constrained_node(grid, patch, [&](int node, unsigned constrained) {
    if (own[node] == 0.0) return;
    Vec<double, D> s = vector(node);
    for (int a = 0; a < D; ++a)
      if (!(constrained >> a & 1u)) s[a] = 0.0;
    const Index<D> place = index_of(grid, patch, node);
    to.add(in_space<D>(grid.position_of(place)), s,
           [&](int axis) { return grid.walls_of(patch.body).faces_holding(place, axis); });
  });
}

/// The same of the dashpots on the nodes that a patch owns.
template <int D>
void add_dashpots(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                  const double* own, double time_step, const Reaction<D>& to) {
  for (int n = 0; n < block.count; ++n) {
    Vec<double, D> impulse;
    for (int a = 0; a < D; ++a) impulse[a] = time_step * own[n] * block.dashpot_force(a)[n];
    if (dot(impulse, impulse) == 0.0) continue;
    const Index<D> place = index_of(grid, patch, n);
    to.add(in_space<D>(grid.position_of(place)), impulse,
           [&](int) { return grid.walls.faces_absorbing(place); });
  }
}

/// And of the faces that touch, each with its own force.
template <int D>
void add_touching(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                  const double* own, double time_step, const Reaction<D>& to) {
  if (block.springs.data == nullptr) return;
  for (int n = 0; n < block.count; ++n)
    for (int normal = 0; normal < D; ++normal) {
      Vec<double, D> impulse;
      for (int a = 0; a < D; ++a) impulse[a] = time_step * own[n] * block.face_force(normal, a)[n];
      if (impulse[normal] == 0.0) continue;  // no friction without it
      to.add(place_of(grid, patch, n), impulse,
             [&](int) { return 1u << (2 * normal + (impulse[normal] > 0.0 ? 0 : 1)); });
    }
}

}  // namespace mpm
