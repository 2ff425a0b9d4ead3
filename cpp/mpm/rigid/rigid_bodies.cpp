// Bodies that move as one: after eq. (17) their velocities are replaced by the rigid motion of the
// same momentum and angular momentum, and they take the place of eq. (16) that this motion gives.
#include "mpm/rigid/prescribed_bodies.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

template <int D>
Vector3 position(const ParticlePool<D>& pool, std::uint32_t row) {
  return in_space<D>(pool.position_of(row));
}

/// f(body, k) for the rigid bodies of which there is anything left to move; k: place among them.
template <int D, class F>
void for_each_moving(Domain<D>& domain, F&& f) {
  for (std::size_t k = 0; k < domain.rigid.size(); ++k)
    if (const Body<D>& body = domain.bodies[domain.rigid_bodies[k]]; body.active() > 0) f(body, k);
}

/// The place of a patch's body among the rigid ones.
template <int D>
std::size_t rigid_of(Domain<D>& domain, const Patch<D>& patch) {
  return static_cast<std::size_t>(domain.body_of(patch).rigid);
}

/// Sums of each rigid body about the centres in `domain.rigid`.
template <int D>
void gather(Domain<D>& domain) {
  auto& parts = domain.rigid_parts;
  // Per patch, in the order of its particles, and then over patches exactly: whichever thread.
  parts.assign(domain.grid.patches.size(), {});
  for_each_patch(domain, free_rigid, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const ParticlePool<D>& pool = domain.pool_of(patch);
    const Vector3 centre = domain.rigid[rigid_of(domain, patch)].centre;
    for (const std::uint32_t row : pool.rows(patch)) {
      parts[p].add(pool.mass()[row], position(pool, row) - centre, velocity_in_space(pool, row));
      for (int a = 0; a < D; ++a)
        // In cells from node 0, as walls are.
        parts[p].extent.add(a, domain.grid.among_nodes(pool.x(a)[row], a));
    }
  });
  domain.rigid_sums.assign(domain.rigid.size(), {});
  for_each_moving(domain, [&](const Body<D>&, std::size_t k) {
    const auto patches =
        patches_of<D>(domain.grid.patches, static_cast<int>(domain.rigid_bodies[k]));
    // The patches of a body follow each other, and `parts` is in the order of the patches.
    const std::ptrdiff_t first = patches.data() - domain.grid.patches.data();
    RigidTotal total;
    for (std::size_t p = 0; p < patches.size(); ++p)
      total.add(parts[static_cast<std::size_t>(first) + p]);
    total.add_others(*domain.grid.partition.comm);
    domain.rigid_sums[k] = total.value();
  });
}

/// Along each axis the faces, as bits 2 axis + side, that hold a body of that extent: half a
/// particle lies between its particles and the face. Held nodes have no increment, but a body that
/// is not stressed is not stopped by that alone: so its motion is held as a whole.
template <int D>
std::array<unsigned, 3> holding_faces(const Domain<D>& domain, const Body<D>& body,
                                      const Extent& extent, const Vector3& velocity) {
  const auto& grid = domain.grid;
  std::array<unsigned, 3> holding{};
  if (!grid.walls.exist) return holding;
  const double reach = 0.5 * body.mean_edge / grid.cell_size;
  for (int a = 0; a < D; ++a)
    for (int side = 0; side < 2; ++side) {
      const Wall wall = grid.walls.face[a][side];
      // Nodes on an absorbing face are not held, and rigid bodies have no dashpots.
      if (wall == Wall::free || wall == Wall::absorbing) continue;
      // From one that touches it may part.
      if (wall == Wall::contact && (side == 0 ? velocity[a] : -velocity[a]) > 0.0) continue;
      const double nearest = side == 0
                                 ? extent.lower[a]
                                 : grid.walls.cells[static_cast<std::size_t>(a)] - extent.upper[a];
      // A thousandth of a cell for rounding.
      if (nearest > reach + 1e-3) continue;
      for (int held = 0; held < D; ++held)
        if (wall == Wall::fixed || held == a)
          holding[static_cast<std::size_t>(held)] |= 1u << (2 * a + side);
    }
  return holding;
}

/// Give a patch's particles the motion of their body.
template <int D>
void set_velocities(ParticlePool<D>& pool, const Patch<D>& patch, const RigidMotion& motion,
                    PatchSums<D>& sums) {
  double kinetic = 0.0, fastest = 0.0;
  for (int a = 0; a < D; ++a) sums.momentum[a] = 0.0;
  for (const std::uint32_t row : pool.rows(patch)) {
    // At the place where the particle is now: called before and after the move.
    const Vector3 v = motion.velocity_at(position(pool, row));
    const double m = pool.mass()[row], square = dot(v, v);
    for (int a = 0; a < D; ++a) {
      pool.v(a)[row] = static_cast<Storage>(v[a]);
      sums.momentum[a] += m * v[a];
    }
    kinetic += 0.5 * m * square;
    fastest = std::max(fastest, square);
  }
  // |v| alone: no wave of a rigid body limits the time step. From the squares, one root a patch.
  sums.stress.fastest = std::sqrt(fastest);
  // What differs from the velocities before is numerical: increments are not rigid, and (second
  // time in a step) places have changed. Counted as energy of the time integration.
  sums.made_rigid += sums.kinetic - kinetic;
  sums.kinetic = kinetic;
}

/// Centre, velocity, spin and inertia of every rigid body.
template <int D>
void find_rigid_motion(Domain<D>& domain) {
  // Twice: about a centre that is far off, inertia would be a difference of large numbers. The
  // first pass is about that of the last step and finds the centre, the second has r small and sum
  // m r = 0 but for rounding, so that momentum and spin come apart.
  gather(domain);
  for_each_moving(domain, [&](const Body<D>&, std::size_t k) {
    domain.rigid[k].centre += (1.0 / domain.rigid_sums[k].mass) * domain.rigid_sums[k].first;
  });
  gather(domain);
  for_each_moving(domain, [&](const Body<D>& body, std::size_t k) {
    const RigidSums& sums = domain.rigid_sums[k];
    RigidMotion& motion = domain.rigid[k];
    // Linear momentum by the mass, angular by the inertia: the rigid field nearest to the
    // velocities of eq. (17) in the norm of kinetic energy, so that the projection takes energy and
    // never gives any.
    motion.velocity = (1.0 / sums.mass) * sums.momentum;
    motion.inertia = sums.inertia;
    const std::array<unsigned, 3> holding =
        holding_faces(domain, body, sums.extent, motion.velocity);
    unsigned constrained = 0;
    for (unsigned a = 0; a < 3; ++a) constrained |= holding[a] != 0 ? 1u << a : 0u;
    const Vector3 before = cross(motion.centre, sums.momentum) + sums.angular;
    // In the plane about z alone.
    motion.free_axes = D == 2 ? 4u : 7u;
    for (int a = 0; a < 3; ++a) {
      if (constrained >> a & 1u) {
        if (a < D)
          domain.rigid_at_faces.add(holding[static_cast<std::size_t>(a)], a,
                                    -sums.mass * motion.velocity[a]);
        motion.velocity[a] = 0.0;
      }
      // A body that stands on a face turns about the face's normal only: about axis a if no axis
      // but a is held.
      if (constrained & ~(1u << a)) motion.free_axes &= ~(1u << a);
    }
    motion.spin = spin_of(motion.inertia, sums.angular, motion.free_axes);
    if (constrained == 0) return;
    const Vector3 after =
        cross(motion.centre, sums.mass * motion.velocity) + motion.inertia * motion.spin;
    domain.rigid_at_walls += after - before;
  });
}

}  // namespace

template <int D>
void project_rigid_velocities(Domain<D>& domain) {
  if (!domain.has_rigid()) return;
  find_rigid_motion(domain);
  for_each_patch(domain, free_rigid, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    set_velocities(domain.pool_of(patch), patch, domain.rigid[rigid_of(domain, patch)],
                   domain.sums[p]);
  });
}

template <int D>
void move_rigid_bodies(Domain<D>& domain) {
  if (domain.has_prescribed()) move_prescribed_bodies(domain);
  if (!domain.has_rigid()) return;
  auto& before = domain.rigid_before;
  auto& turns = domain.rigid_turns;
  // The centre of the start of the step, about which particles turn; no allocation once it has its
  // size.
  before = domain.rigid;
  turns.resize(domain.rigid.size());
  for_each_moving(domain, [&](const Body<D>&, std::size_t k) {
    turns[k] = turn(domain.rigid[k], domain.time_step);
  });
  for_each_patch(domain, free_rigid, [&](std::size_t p) {
    Patch<D>& patch = domain.grid.patches[p];
    ParticlePool<D>& pool = domain.pool_of(patch);
    const std::size_t r = rigid_of(domain, patch);
    patch.left_cell = false;
    for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k) {
        const std::uint32_t row = cell.rows[k];
        const Vector3 x =
            // From the centre anew, so that distances in the body grow by rounding alone, not with
            // the step as by x + v dt.
            domain.rigid[r].centre + turns[r] * (position(pool, row) - before[r].centre);
        for (int a = 0; a < D; ++a) {
          pool.x(a)[row] = x[a];
          // As lists do (CellCoordinates), so that both agree on who has left.
          const double local = domain.grid.in_cells(x[a], a) - cell.cell[a];
          patch.left_cell = patch.left_cell || local < 0.0 || local >= 1.0;
        }
      }
    });
    // With the spin and the places of the end of the step.
    set_velocities(pool, patch, domain.rigid[r], domain.sums[p]);
  });
}

template void project_rigid_velocities<2>(Domain<2>&);
template void project_rigid_velocities<3>(Domain<3>&);
template void move_rigid_bodies<2>(Domain<2>&);
template void move_rigid_bodies<3>(Domain<3>&);

}  // namespace mpm
