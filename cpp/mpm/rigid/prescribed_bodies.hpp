#pragma once
// Bodies whose motion is prescribed: their nodes and particles have the velocity of that motion,
// whatever acts on them. They have no stress, and give mass to nodes only where others are near;
// the momentum that comes with it is overwritten (find_velocities).
#include "mpm/domain.hpp"
#include "mpm/schedule/cell_loop.hpp"

namespace mpm {

/// Give all nodes of a patch the velocity of a rigid motion.
template <int D>
void set_rigid_velocity(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                        const RigidMotion& motion) {
  const Index<D> first = grid.first_cell(patch.tile);
  for (int n = 0; n < patch.shape.node_count; ++n) {
    Index<D> node = patch.shape.index(n);
    for (int a = 0; a < D; ++a) node[a] += first[a];
    // At the node itself, not mapped from particles: exact in a rotation, and at nodes without
    // particles too.
    const Vector3 v = motion.velocity_at(in_space<D>(grid.position_of(node)));
    for (int a = 0; a < D; ++a) block.velocity(a)[n] = v[a];
  }
}

/// In place of eqs. (8) and (10): the nodes of a patch take the velocity prescribed for this step.
/// What contact pushes them with goes to the ledger.
template <int D>
void advance_prescribed_nodes(Domain<D>& domain, std::size_t p);

/// Positions and velocities of the particles after the step, in place of eqs. (16) and (17).
template <int D>
void move_prescribed_bodies(Domain<D>& domain);

}  // namespace mpm
