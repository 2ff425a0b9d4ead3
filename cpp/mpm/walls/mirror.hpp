#pragma once
// Walls for a basis that reaches beyond them: slip walls are planes of symmetry. What particles
// give to a node beyond the wall belongs to its image, with the component along the normal turned;
// and such a node moves as its image does, turned likewise. So half a body at a wall moves as the
// half of a whole one, to rounding (decision 0010). At an odd fixed wall all components are turned.
// The mass of the node beyond stays there, for gravity: it pulls the mirrored particles the other
// way.
#include "mpm/step/node_loops.hpp"

namespace mpm {

/// f(node, number of its image, image) for the nodes of a block that lie beyond walls and have one.
template <int D, class F>
void for_each_ghost_node(const TileGrid<D>& grid, const Patch<D>& patch, F&& f) {
  const BlockShape<D>& shape = patch.shape;
  // The linear basis reaches no node beyond a wall that its particles are not beyond.
  if (!patch.at_wall || !grid.has_ghosts()) return;
  const Index<D> first = grid.first_cell(patch.tile);
  const Walls<D>& walls = grid.walls_of(patch.body);
  for (int n = 0; n < shape.node_count; ++n) {
    Index<D> node = shape.index(n);
    for (int a = 0; a < D; ++a) node[a] += first[a];
    const auto image = walls.image(node);
    if (!image) continue;
    Index<D> in_block = image->node;
    for (int a = 0; a < D; ++a) in_block[a] -= first[a];
    if (shape.holds(in_block)) f(n, shape.node(in_block), *image);
  }
}

/// 1 at the nodes that a patch owns, 0 at those that another patch counts and at those beyond
/// walls, of which mass and force have been folded to their images: as factors, so that a loop over
/// nodes has no branch and each shared node enters the ledger once.
template <int D>
void own_nodes(const TileGrid<D>& grid, const Patch<D>& patch, double* own) {
  for (int n = 0; n < patch.shape.node_count; ++n) own[n] = patch.counts(n) ? 1.0 : 0.0;
  for_each_ghost_node(grid, patch, [&](int node, int, const WallImage<D>&) { own[node] = 0.0; });
}

/// Before the shared nodes are summed: move the vector at number `at` of the records from beyond
/// the walls to the images; with the velocity, the mass as well.
template <int D>
void fold_at_walls(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                   int at) {
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    double *const of_node = block.records[node], *const of_image = block.records[image];
    // With the momentum alone: the remapped one and the forces find the mass folded. It is not
    // taken from the node beyond, whose weight is still to be counted (ghost_weight).
    if (at == momentum_at) of_image[mass_at] += of_node[mass_at];
    for (int k = at, a = 0; a < D; ++k, ++a) {
      // Moved and not copied: what was given counts once, and at the image.
      of_image[k] += turned.component(of_node[k], a);
      of_node[k] = 0.0;
    }
  });
}

/// What the mass of a node beyond a wall adds too much to the weight of its image along a turned
/// axis, where gravity pulls mirrored particles the other way [N]: the image has the mass m + m_g,
/// so the weight (m + m_g) g, and should have (m - m_g) g.
template <int D>
double ghost_weight(const Domain<D>& domain, const NodeBlock<D>& block, int node, int axis) {
  return 2.0 * block.mass()[node] * domain.gravity[axis];
}

/// f(image, axis, weight) for what `ghost_weight` gives, each once: by the patch that owns the node
/// beyond the wall. Not every patch that holds the image holds that node as well.
template <int D, class F>
void for_each_ghost_weight(const Domain<D>& domain, const Patch<D>& patch,
                           const NodeBlock<D>& block, F&& f) {
  for_each_ghost_node(domain.grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    // By the mass after the exchange, the sum of what all patches gave to the node.
    if (!patch.counts(node)) return;
    for (int a = 0; a < D; ++a)
      if (turned.turned >> a & 1u) f(image, a, ghost_weight(domain, block, node, a));
  });
}

/// Before the shared nodes are summed: each patch for the mass that its own particles have given,
/// so that every patch that holds an image has its force. The weights of an image are added to each
/// other first, so that it does not matter what the force already holds.
template <int D>
void subtract_ghost_weight(const Domain<D>& domain, const Patch<D>& patch,
                           const NodeBlock<D>& block) {
  if (!patch.at_wall || !domain.grid.has_ghosts()) return;
  // Near an edge of the box a node is the image of several; in 3D 5 kB of the stack.
  double weights[BlockShape<D>::nodes_max][D];
  std::fill_n(weights[0], D * block.count, 0.0);
  for_each_ghost_node(domain.grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    for (int a = 0; a < D; ++a)
      if (turned.turned >> a & 1u) weights[image][a] -= ghost_weight(domain, block, node, a);
  });
  for (int n = 0; n < block.count; ++n)
    for (int a = 0; a < D; ++a) block.ghost_weight(a)[n] += weights[n][a];
}

/// The same of the volumes of matter that flows, which have no direction.
template <int D>
void fold_volumes(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block) {
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>&) {
    block.records[image][volume_at] += block.records[node][volume_at];
    block.records[node][volume_at] = 0.0;
  });
}
/// After the sums: a node beyond a wall has as much around it as its image.
template <int D>
void reflect_volumes(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block) {
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>&) {
    block.records[node][volume_at] = block.records[image][volume_at];
  });
}

/// When the nodes have their velocities, the vector at number `at` of the records: those beyond the
/// walls take their images'.
template <int D>
void reflect_at_walls(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                      int at) {
  for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>& turned) {
    // The image has the same vector in all patches that hold it, so that no exchange follows.
    double *const of_node = block.records[node] + at, *const of_image = block.records[image] + at;
    for (int a = 0; a < D; ++a) of_node[a] = turned.component(of_image[a], a);
  });
}

}  // namespace mpm
