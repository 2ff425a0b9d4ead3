#include "mpm/rigid/prescribed_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "mpm/step/patch_loops.hpp"

namespace mpm {
namespace {

/// Move a patch's particles, give them their velocities and sum what the ledger needs.
template <int D>
void move_patch(const TileGrid<D>& grid, const RigidMotion& motion, ParticlePool<D>& pool,
                Patch<D>& patch, const Matrix3& turned, double time_step, PatchSums<D>& sums) {
  const bool turns = dot(motion.spin, motion.spin) > 0.0;
  // The velocities are means over the step, so that the displacement of the centre is their
  // integral.
  const Vector3 centre = motion.centre + time_step * motion.velocity;
  double kinetic = 0.0, fastest = 0.0;
  patch.left_cell = false;
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    for (std::uint32_t k = 0; k < cell.count; ++k) {
      const std::uint32_t row = cell.rows[k];
      Vector3 v = motion.velocity, x = Vector3::zero();
      for (int a = 0; a < D; ++a) x[a] = pool.x(a)[row];
      if (turns) {
        x = centre + turned * (x - motion.centre);
        // v at the place where the particle comes to be, which is where the next step maps it.
        v += cross(motion.spin, x - centre);
      } else {
        x += time_step * v;
      }
      const double m = pool.mass()[row], square = dot(v, v);
      for (int a = 0; a < D; ++a) {
        pool.x(a)[row] = x[a];
        pool.v(a)[row] = static_cast<Storage>(v[a]);
        sums.momentum[a] += m * v[a];
        // As lists do (CellCoordinates).
        const double local = grid.in_cells(x[a], a) - cell.cell[a];
        patch.left_cell = patch.left_cell || local < 0.0 || local >= 1.0;
      }
      kinetic += 0.5 * m * square;
      fastest = std::max(fastest, square);
    }
  });
  sums.kinetic = kinetic;
  // |v| alone: its waves do not limit the time step.
  sums.stress.fastest = std::sqrt(fastest);
  // For the work of the motion: the ledger takes their change since the last step, less what
  // contact gave (docs/theory/motion.md).
  sums.prescribed.kinetic = kinetic;
  for (int a = 0; a < D; ++a) sums.prescribed.momentum[a] = sums.momentum[a];
}

}  // namespace

template <int D>
void advance_prescribed_nodes(Domain<D>& domain, std::size_t p) {
  const auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  // Its nodes are mapped only where another body is near, and no one else reads them.
  if (!patch.in_contact) return;
  const PrescribedMotion& motion = *domain.body_of(patch).motion;
  const NodeBlock<D> block = domain.grid.block(p);
  const Index<D> first = grid.first_cell(patch.tile);
  PatchSums<D>& sums = domain.sums[p];
  for (int n = 0; n < patch.shape.node_count; ++n) {
    Index<D> node = patch.shape.index(n);
    for (int a = 0; a < D; ++a) node[a] += first[a];
    const Vector3 place = in_space<D>(grid.position_of(node));
    const Vector3 dv = motion.increment_at(place);
    const bool own = patch.counts(n);
    if (own)
      sums.angular.on_prescribed +=
          domain.time_step * cross(place, in_space<D>(block.vector(n, force_at)));
    for (int a = 0; a < D; ++a) {
      // The force here is that of contact alone, as no stress is mapped and no gravity added: with
      // the time step J_i, which is finite though the mass counts as infinite.
      const double pushed = own ? domain.time_step * block.force(a)[n] : 0.0;  // [N s]
      // J . w into B and J . dw / 2 into S, as for free bodies, with w that of the last step
      // (docs/theory/motion.md).
      sums.force_work += pushed * block.velocity(a)[n];
      sums.second_order += 0.5 * pushed * dv[a];
      sums.prescribed.impulse[a] += pushed;
      block.velocity(a)[n] += dv[a];
      block.increment(a)[n] = dv[a];
    }
  }
  // The velocity changes evenly over the step.
  sums.prescribed.work = sums.force_work + sums.second_order;
}

template <int D>
void move_prescribed_bodies(Domain<D>& domain) {
  auto& grid = domain.grid;
  for_each_patch(domain, prescribed, [&](std::size_t p) {
    Patch<D>& patch = grid.patches[p];
    const PrescribedMotion& motion = *domain.body_of(patch).motion;
    // A fixed one keeps its places, and its sums stay 0.
    if (!motion.moves) return;
    const Matrix3 turned = rotation(domain.time_step * motion.now.spin);
    move_patch(grid, motion.now, domain.pool_of(patch), patch, turned, domain.time_step,
               domain.sums[p]);
  });
  // After all patches, which turn about the centre of the start of the step.
  for (const std::size_t b : domain.prescribed) {
    RigidMotion& motion = domain.bodies[b].motion->now;
    motion.centre += domain.time_step * motion.velocity;
  }
}

template void advance_prescribed_nodes<2>(Domain<2>&, std::size_t);
template void advance_prescribed_nodes<3>(Domain<3>&, std::size_t);
template void move_prescribed_bodies<2>(Domain<2>&);
template void move_prescribed_bodies<3>(Domain<3>&);

}  // namespace mpm
