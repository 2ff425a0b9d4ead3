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

/// Before the shared nodes are summed: move the vector at number `at` of the lines from beyond the
/// walls to the images; with the velocity, the mass as well.
template <int D>
void fold_at_walls(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                   int at) {
  for_each_mirrored_node(grid, patch, [&](int node, int image, unsigned axes) {
    double *const of_node = block.lines[node], *const of_image = block.lines[image];
    if (at == velocity_at) of_image[mass_at] += of_node[mass_at];
    for (int k = at, a = 0; a < D; ++k, ++a) {
      of_image[k] += axes >> a & 1u ? -of_node[k] : of_node[k];
      of_node[k] = 0.0;
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
  double weights[BlockShape<D>::nodes_max][D];
  std::fill_n(weights[0], D * block.count, 0.0);
  for_each_mirrored_node(domain.grid, patch, [&](int node, int image, unsigned axes) {
    for (int a = 0; a < D; ++a)
      if (axes >> a & 1u) weights[image][a] -= mirrored_weight(domain, block, node, a);
  });
  for (int n = 0; n < block.count; ++n)
    for (int a = 0; a < D; ++a) block.force(a)[n] += weights[n][a];
}

/// When the nodes have their velocities, the vector at number `at` of the lines: those beyond the
/// walls take their images'.
template <int D>
void reflect_at_walls(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                      int at) {
  for_each_mirrored_node(grid, patch, [&](int node, int image, unsigned axes) {
    double *const of_node = block.lines[node] + at, *const of_image = block.lines[image] + at;
    for (int a = 0; a < D; ++a) of_node[a] = axes >> a & 1u ? -of_image[a] : of_image[a];
  });
}

}  // namespace mpm
