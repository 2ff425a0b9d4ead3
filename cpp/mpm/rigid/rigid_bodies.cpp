// Bodies that move as one: after eq. (17) their velocities are replaced by the rigid motion of the
// same momentum and angular momentum, and they take the place of eq. (16) that this motion gives.
#include <span>

#include "mpm/rigid/prescribed_bodies.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

template <int D>
Vector3 position(const Body<D>& body, std::uint32_t row) {
  Vec<double, D> x;
  for (int a = 0; a < D; ++a) x[a] = body.x(a)[row];
  return in_space<D>(x);
}

template <int D>
Vector3 velocity(const Body<D>& body, std::uint32_t row) {
  Vec<double, D> v;
  for (int a = 0; a < D; ++a) v[a] = body.v(a)[row];
  return in_space<D>(v);
}

/// Is there anything of it left to move?
template <int D>
bool moves(const Body<D>& body) {
  return body.is_free_rigid() && body.active() > 0;
}

/// f(patch number, rows of its particles) for the patches of rigid bodies.
template <int D, class F>
void for_each_rigid_patch(Domain<D>& domain, F&& f) {
  for_each_patch(domain, free_rigid, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    f(p, std::span(domain.body_of(patch).order).subspan(patch.begin, patch.count));
  });
}

/// Sums of each rigid body about the centres in `domain.rigid`, in the order of the patches.
template <int D>
void gather(Domain<D>& domain) {
  auto& parts = domain.rigid_parts;
  parts.assign(domain.grid.patches.size(), {});
  for_each_rigid_patch(domain, [&](std::size_t p, std::span<const std::uint32_t> rows) {
    const Patch<D>& patch = domain.grid.patches[p];
    const Body<D>& body = domain.body_of(patch);
    const Vector3 centre = domain.rigid[static_cast<std::size_t>(patch.body)].centre;
    for (const std::uint32_t row : rows) {
      parts[p].add(body.mass()[row], position(body, row) - centre, velocity(body, row));
      for (int a = 0; a < D; ++a)
        parts[p].extent.add(a, domain.grid.among_nodes(body.x(a)[row], a));
    }
  });
  domain.rigid_sums.assign(domain.bodies.size(), {});
  // The patches of a body follow one another.
  for (std::size_t p = 0; p < parts.size();) {
    const int body = domain.grid.patches[p].body;
    const std::size_t begin = p;
    while (p < parts.size() && domain.grid.patches[p].body == body) ++p;
    const auto b = static_cast<std::size_t>(body);
    if (!moves(domain.bodies[b])) continue;
    RigidTotal total;
    for (std::size_t k = begin; k < p; ++k) total.add(parts[k]);
    domain.rigid_sums[b] = total.value();
  }
}

/// Axes along which walls hold a body of that extent: half a particle lies between its particles
/// and the face.
template <int D>
unsigned held_axes(const Domain<D>& domain, const Body<D>& body, const Extent& extent) {
  const auto& grid = domain.grid;
  unsigned held = 0;
  if (!grid.walls.exist) return held;
  const double reach = 0.5 * body.mean_edge / grid.cell_size;
  for (int a = 0; a < D; ++a)
    for (int side = 0; side < 2; ++side) {
      const Wall wall = grid.walls.face[a][side];
      if (wall == Wall::free || wall == Wall::absorbing) continue;
      const double nearest = side == 0
                                 ? extent.lower[a]
                                 : grid.walls.cells[static_cast<std::size_t>(a)] - extent.upper[a];
      // A thousandth of a cell for rounding.
      if (nearest <= reach + 1e-3) held |= wall == Wall::fixed ? (1u << D) - 1u : 1u << a;
    }
  return held;
}

/// Give a patch's particles the motion of their body.
template <int D>
void set_velocities(Body<D>& body, std::span<const std::uint32_t> rows, const RigidMotion& motion,
                    PatchSums<D>& sums) {
  double kinetic = 0.0, fastest = 0.0;
  for (int a = 0; a < D; ++a) sums.momentum[a] = 0.0;
  for (const std::uint32_t row : rows) {
    const Vector3 v = motion.velocity_at(position(body, row));
    const double m = body.mass()[row], square = dot(v, v);
    for (int a = 0; a < D; ++a) {
      body.v(a)[row] = static_cast<Rounded>(v[a]);
      sums.momentum[a] += m * v[a];
    }
    kinetic += 0.5 * m * square;
    fastest = std::max(fastest, square);
  }
  sums.stress.fastest = std::sqrt(fastest);
  // What differs from the velocities before is numerical: increments are not rigid.
  sums.made_rigid += sums.kinetic - kinetic;
  sums.kinetic = kinetic;
}

/// Centre, velocity, spin and inertia of every rigid body.
template <int D>
void find_rigid_motion(Domain<D>& domain) {
  // Twice: about a centre that is far off, inertia would be a difference of large numbers.
  gather(domain);
  for (std::size_t b = 0; b < domain.bodies.size(); ++b)
    if (moves(domain.bodies[b]))
      domain.rigid[b].centre += (1.0 / domain.rigid_sums[b].mass) * domain.rigid_sums[b].first;
  gather(domain);
  for (std::size_t b = 0; b < domain.bodies.size(); ++b) {
    if (!moves(domain.bodies[b])) continue;
    const RigidSums& sums = domain.rigid_sums[b];
    RigidMotion& motion = domain.rigid[b];
    motion.velocity = (1.0 / sums.mass) * sums.momentum;
    motion.inertia = sums.inertia;
    const unsigned held = held_axes(domain, domain.bodies[b], sums.extent);
    motion.free_axes = D == 2 ? 4u : 7u;
    for (int a = 0; a < 3; ++a) {
      if (held >> a & 1u) motion.velocity[a] = 0.0;
      // A body that stands on a face turns about the face's normal only.
      if (held & ~(1u << a)) motion.free_axes &= ~(1u << a);
    }
    motion.spin = spin_of(motion.inertia, sums.angular, motion.free_axes);
  }
}

}  // namespace

template <int D>
void hold_rigid_bodies(Domain<D>& domain) {
  if (!domain.has_rigid()) return;
  find_rigid_motion(domain);
  for_each_rigid_patch(domain, [&](std::size_t p, std::span<const std::uint32_t> rows) {
    const Patch<D>& patch = domain.grid.patches[p];
    set_velocities(domain.body_of(patch), rows, domain.rigid[static_cast<std::size_t>(patch.body)],
                   domain.sums[p]);
  });
}

template <int D>
void move_rigid_bodies(Domain<D>& domain) {
  if (domain.has_prescribed()) move_prescribed_bodies(domain);
  if (!domain.has_rigid()) return;
  auto& before = domain.rigid_before;
  auto& turns = domain.rigid_turns;
  before = domain.rigid;
  turns.resize(domain.bodies.size());
  for (std::size_t b = 0; b < domain.bodies.size(); ++b)
    if (moves(domain.bodies[b])) turns[b] = turn(domain.rigid[b], domain.time_step);
  for_each_rigid_patch(domain, [&](std::size_t p, std::span<const std::uint32_t> rows) {
    Patch<D>& patch = domain.grid.patches[p];
    Body<D>& body = domain.body_of(patch);
    const auto b = static_cast<std::size_t>(patch.body);
    patch.left_cell = false;
    for_each_cell(domain.grid, body, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k) {
        const std::uint32_t row = cell.rows[k];
        const Vector3 x =
            domain.rigid[b].centre + turns[b] * (position(body, row) - before[b].centre);
        for (int a = 0; a < D; ++a) {
          body.x(a)[row] = x[a];
          const double local = domain.grid.in_cells(x[a], a) - cell.cell[a];
          patch.left_cell = patch.left_cell || local < 0.0 || local >= 1.0;
        }
      }
    });
    set_velocities(body, rows, domain.rigid[b], domain.sums[p]);
  });
}

template void hold_rigid_bodies<2>(Domain<2>&);
template void hold_rigid_bodies<3>(Domain<3>&);
template void move_rigid_bodies<2>(Domain<2>&);
template void move_rigid_bodies<3>(Domain<3>&);

}  // namespace mpm
