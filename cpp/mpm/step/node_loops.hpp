#pragma once
// Loops over the nodes of a patch.
#include "mpm/domain.hpp"

namespace mpm {

/// Set the first numbers, whole halves of their records, of `count` nodes to zero.
template <int width>
void clear(const Nodes<width>& nodes, int count, int numbers) {
  for (int n = 0; n < count; ++n)
    for (int k = 0; k < numbers; k += half_record) Batch<half_record>(0.0).store(nodes[n] + k);
}

/// Copy half the records of `count` nodes.
inline void copy_halves(const NodeRecords& to, const HalfRecords& from, int count) {
  for (int n = 0; n < count; ++n) Batch<half_record>::load(from[n]).store(to[n]);
}

/// f(node, constrained axes) for the nodes of a patch that walls hold.
template <int D, class F>
void for_each_constrained_node(const TileGrid<D>& grid, const Patch<D>& patch, F&& f) {
  // Found when blocks are cut, so that patches inside the box cost nothing.
  if (!patch.at_wall) return;
  const Index<D> first = grid.first_cell(patch.tile);
  const Walls<D>& walls = grid.walls_of(patch.body);
  for (int n = 0; n < patch.shape.node_count; ++n) {
    Index<D> node = patch.shape.index(n);
    for (int a = 0; a < D; ++a) node[a] += first[a];
    if (const unsigned constrained = walls.constrained_axes(node)) f(n, constrained);
  }
}

/// Turn momenta [kg m/s], the vector at number `at` of the records, into velocities [m/s]: zero
/// without mass, and along axes held by walls.
template <int D>
void momentum_to_velocity(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                          int at) {
  for (int n = 0; n < block.count; ++n) {
    double* const numbers = block.records[n];
    // One division a node in place of D. No least mass: the momentum vanishes with the mass, so
    // that v_i is a mean of v_p however small the mass is.
    const double inverse = numbers[mass_at] > 0.0 ? 1.0 / numbers[mass_at] : 0.0;
    for (int a = 0; a < D; ++a) numbers[at + a] *= inverse;
  }
  // Overwritten and not left out of the loop above, which so has no branch.
  for_each_constrained_node(grid, patch, [&](int node, unsigned constrained) {
    for (int a = 0; a < D; ++a)
      if (constrained >> a & 1u) block.records[node][at + a] = 0.0;
  });
}

}  // namespace mpm
