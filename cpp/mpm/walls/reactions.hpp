#pragma once
// What walls give to the angular momentum: the reactions of the nodes that they hold, and what
// moving a vector from a node beyond them to its image does to its moment.
//
// Particles give a node g beyond a wall f_g, and get its increment dv_g, which is that of its image
// turned, R dv_i. So what acts on it beside f_g is m_g dv_g / dt - f_g - m_g g, at x_g. The image
// has the mass m_i + m_g, and f_i + R f_g: what acts on it beside f_i is the rest, at x_i. Both
// together are x_i x R s - x_g x s for s = f_g + m_g g - m_g dv_g / dt, the first of which is at
// hand when forces are folded, the others when nodes have been advanced.
#include <type_traits>

#include "mpm/rigid/prescribed_motion.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {

/// The place of a node of a patch, by its index from the tile's first or by its number [m].
template <int D>
Vector3 place_of(const TileGrid<D>& grid, const Patch<D>& patch,
                 std::type_identity_t<Index<D>> node) {
  const Index<D> first = grid.first_cell(patch.tile);
  for (std::size_t a = 0; a < D; ++a) node[a] += first[a];
  return in_space<D>(grid.position_of(node));
}
template <int D>
Vector3 place_of(const TileGrid<D>& grid, const Patch<D>& patch, int node) {
  return place_of(grid, patch, patch.shape.index(node));
}

/// Sum of x_i x R s - x_g x s over the nodes beyond walls, s = vector(node) in D components.
template <int D, class F>
Vector3 moment_of_folding(const TileGrid<D>& grid, const Patch<D>& patch, F&& vector) {
  Vector3 moment = Vector3::zero();
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    const Vec<double, D> s = vector(node);
    Vec<double, D> of_image;
    for (int a = 0; a < D; ++a) of_image[a] = turned.component(s[a], a);
    moment += cross(place_of(grid, patch, image), in_space<D>(of_image)) -
              cross(place_of(grid, patch, node), in_space<D>(s));
  });
  return moment;
}

/// Sum of x_i x s over the nodes that walls hold, with the components of s = vector(node) along the
/// axes that they hold; each node once, by `own`, which is 0 beyond walls with images.
template <int D, class F>
Vector3 moment_held(const TileGrid<D>& grid, const Patch<D>& patch, const double* own, F&& vector) {
  Vector3 moment = Vector3::zero();
  for_each_constrained_node(grid, patch, [&](int node, unsigned constrained) {
    Vec<double, D> s = vector(node);
    for (int a = 0; a < D; ++a)
      if (!(constrained >> a & 1u)) s[a] = 0.0;
    moment += own[node] * cross(place_of(grid, patch, node), in_space<D>(s));
  });
  return moment;
}

/// Sum of x_i x f_i over the dashpots on the nodes that a patch owns [N m].
template <int D>
Vector3 moment_of_dashpots(const TileGrid<D>& grid, const Patch<D>& patch,
                           const NodeBlock<D>& block, const double* own) {
  Vector3 moment = Vector3::zero();
  for (int n = 0; n < block.count; ++n) {
    Vec<double, D> force;
    for (int a = 0; a < D; ++a) force[a] = own[n] * block.dashpot_force(a)[n];
    if (dot(force, force) > 0.0) moment += cross(place_of(grid, patch, n), in_space<D>(force));
  }
  return moment;
}

}  // namespace mpm
