#pragma once
// Slip walls as planes of symmetry for a basis that reaches beyond them. What particles give to a
// node beyond the wall belongs to its image, with the component along the normal turned; and such a
// node moves as its image does, turned likewise. So half a body at a wall moves as the half of a
// whole one. The mass of the node beyond stays there, for gravity: it pulls the mirrored particles
// the other way.
#include "mpm/step/cell_loop.hpp"

namespace mpm {

/// f(node, image, axes) for the nodes of a block that lie beyond slip walls.
template <int D, class F>
void for_each_mirrored_node(const TileGrid<D>& grid, const Patch<D>& patch, F&& f) {
  const BlockShape<D>& shape = patch.shape;
  if (!patch.at_wall || grid.margin() == 0) return;
  const Index<D> first = grid.first_cell(patch.tile);
  for (int n = 0; n < shape.node_count; ++n) {
    Index<D> node = shape.index(n), image;
    for (int a = 0; a < D; ++a) node[a] += first[a];
    const unsigned axes = grid.walls.mirrored(node, image);
    if (axes == 0) continue;
    for (int a = 0; a < D; ++a) image[a] -= first[a];
    if (shape.holds(image)) f(n, shape.node(image), axes);
  }
}

/// Before the shared nodes are summed: move what lies beyond the walls to the images. `mass` if the
/// mass has been scattered too.
template <int D, class Field>
void fold_at_walls(const TileGrid<D>& grid, const Patch<D>& patch, double* mass, Field&& field) {
  for_each_mirrored_node(grid, patch, [&](int node, int image, unsigned axes) {
    if (mass) mass[image] += mass[node];
    for (int a = 0; a < D; ++a) {
      double* value = field(a);
      value[image] += axes >> a & 1u ? -value[node] : value[node];
      value[node] = 0.0;
    }
  });
}

/// What the mass of a node beyond a wall adds too much to the weight of its image along the normal,
/// where gravity pulls mirrored particles the other way [N].
template <int D>
double mirrored_weight(const Domain<D>& domain, const NodeBlock<D>& block, int node, int axis) {
  return 2.0 * block.mass()[node] * domain.gravity[axis];
}

/// f(image, axis, weight) for what `mirrored_weight` gives, each once: by the patch that owns the
/// node beyond the wall. Not every patch that holds the image holds that node as well.
template <int D, class F>
void for_each_mirrored_weight(const Domain<D>& domain, const Patch<D>& patch,
                              const NodeBlock<D>& block, F&& f) {
  for_each_mirrored_node(domain.grid, patch, [&](int node, int image, unsigned axes) {
    if (!patch.owned[node]) return;
    for (int a = 0; a < D; ++a)
      if (axes >> a & 1u) f(image, a, mirrored_weight(domain, block, node, a));
  });
}

/// Before the shared nodes are summed: each patch for the mass that its own particles have given,
/// so that every patch that holds an image has its force. The weights of an image are added to each
/// other first, so that it does not matter what the force already holds.
template <int D>
void subtract_mirrored_weight(const Domain<D>& domain, const Patch<D>& patch,
                              const NodeBlock<D>& block) {
  if (!patch.at_wall || domain.grid.margin() == 0) return;
  double weights[D * BlockShape<D>::stride_max];
  const int size = D * block.stride;
  std::fill_n(weights, size, 0.0);
  for_each_mirrored_node(domain.grid, patch, [&](int node, int image, unsigned axes) {
    for (int a = 0; a < D; ++a)
      if (axes >> a & 1u)
        weights[a * block.stride + image] -= mirrored_weight(domain, block, node, a);
  });
  for (int i = 0; i < size; ++i) block.force(0)[i] += weights[i];
}

/// When the nodes have their velocities: those beyond the walls take their images'.
template <int D, class Field>
void reflect_at_walls(const TileGrid<D>& grid, const Patch<D>& patch, Field&& field) {
  for_each_mirrored_node(grid, patch, [&](int node, int image, unsigned axes) {
    for (int a = 0; a < D; ++a) {
      double* value = field(a);
      value[node] = axes >> a & 1u ? -value[image] : value[image];
    }
  });
}

}  // namespace mpm
