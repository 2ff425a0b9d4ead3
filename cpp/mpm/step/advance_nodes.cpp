#include "mpm/followers/follow.hpp"
#include "mpm/loads/body_forces.hpp"
#include "mpm/loads/carry_loads.hpp"
#include "mpm/rigid/prescribed_bodies.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/surfaces/parts.hpp"
#include "mpm/surfaces/pressing.hpp"
#include "mpm/walls/absorb.hpp"
#include "mpm/walls/reactions.hpp"
#include "mpm/walls/touch.hpp"

namespace mpm {
namespace {

/// First moment of the mass that a patch's particles have given, sum m_i x_i over the nodes it owns
/// [kg m]. By rows along the first axis, with the indices within the block until the end.
template <int D>
Vector3 first_moment(const TileGrid<D>& grid, const Patch<D>& patch, const NodeBlock<D>& block,
                     const double* own) {
  const Index<D>& nodes = patch.shape.nodes;
  double mass = 0.0;
  Vec<double, D> indices = Vec<double, D>::zero();
  Index<D> row{};
  for (int n = 0; n < block.count; n += nodes[0]) {
    double of_row = 0.0, along = 0.0;
    for (int i = 0; i < nodes[0]; ++i) {
      const double m = own[n + i] * block.records[n + i][mass_at];
      of_row += m;
      along += i * m;
    }
    mass += of_row;
    indices[0] += along;
    for (std::size_t a = 1; a < D; ++a) indices[static_cast<int>(a)] += row[a] * of_row;
    for (std::size_t a = 1; a < D && ++row[a] == nodes[a]; ++a) row[a] = 0;
  }
  return mass * place_of(grid, patch, patch.shape.low) + grid.cell_size * in_space<D>(indices);
}

/// Walls take up the force along the axes they hold. It becomes -m g, the product that gravity adds
/// again in eq. (8), so that dv is 0 to the bit; v is 0 there already (momentum_to_velocity), and
/// neither does work.
template <int D>
void hold_at_walls(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block) {
  for_each_constrained_node(domain.grid, patch, [&](int node, unsigned constrained) {
    for (int a = 0; a < D; ++a)
      if (constrained >> a & 1u) block.force(a)[node] = -block.mass()[node] * domain.gravity[a];
  });
}

/// Eq. (8) for the nodes of a block.
template <int D>
NodeWork advance_block(const NodeBlock<D>& block, const double* own, const Vec<double, D>& gravity,
                       double dt) {
  NodeWork done;
  for (int n = 0; n < block.count; ++n) {
    double* const numbers = block.records[n];
    // Nodes without mass stay at rest. Tiny masses have huge increments; that particles take them
    // weighed with N_ip is what keeps them harmless, except in USL (docs/theory/step.md).
    const double m = numbers[mass_at], impulse = m > 0.0 ? dt / m : 0.0;
    for (int a = 0; a < D; ++a) {
      double& v = numbers[velocity_at + a];
      const double f = numbers[force_at + a], weight = m * gravity[a];
      const double dv = impulse * (f + weight);
      done.work += own[n] * f * v;
      done.gravity_first += own[n] * weight * v;
      done.gravity_second += own[n] * weight * dv;
      v += dv;
      numbers[increment_at + a] = dv;
    }
  }
  return done;
}

/// The same where the body's motion is damped, with the work of that and its angular impulse [N m].
struct DampedWork {
  NodeWork done;
  double unbalanced = 0.0, weight = 0.0;  // sums of the forces' sizes [N]
  Work damping;
  Vector3 moment = Vector3::zero();
};
template <int D>
DampedWork advance_damped_block(const Domain<D>& domain, const Patch<D>& patch,
                                const NodeBlock<D>& block, const double* own,
                                const StepDamping& damping) {
  DampedWork sums;
  const double dt = domain.time_step, acts = time_of_forces(domain, patch);
  for (int n = 0; n < block.count; ++n) {
    double* const numbers = block.records[n];
    const double m = numbers[mass_at];
    Vec<double, D> force = Vec<double, D>::zero(), all = force;
    for (int a = 0; a < D; ++a) {
      double& v = numbers[velocity_at + a];
      const double f = numbers[force_at + a], weight = m * domain.gravity[a];
      DampedNode node{0.0, 0.0};  // at rest without mass
      if (m > 0.0) node = advance_damped(damping, m, v, f + weight, acts);
      force[a] = own[n] * node.damping;
      all[a] = f + weight;
      sums.done.work += own[n] * f * v;
      sums.done.gravity_first += own[n] * weight * v;
      sums.done.gravity_second += own[n] * weight * node.increment;
      sums.damping.first += dt * force[a] * v;
      sums.damping.second += 0.5 * dt * force[a] * node.increment;
      v += node.increment;
      numbers[increment_at + a] = node.increment;
    }
    sums.unbalanced += own[n] * norm(all);
    sums.weight += own[n] * m * norm(domain.gravity);
    if (dot(force, force) > 0.0)
      sums.moment += cross(patch.keeps ? place_of_kept(domain.grid, patch, block, n)
                                       : place_of(domain.grid, patch, n),
                           in_space<D>(force));
  }
  return sums;
}

/// Impulses of the walls on the nodes that they hold: they take up force and weight along these
/// axes. Before `hold_at_walls`.
template <int D>
void add_impulses_of_holding(const Domain<D>& domain, const Patch<D>& patch,
                             const NodeBlock<D>& block, const double* own, const Reaction<D>& to) {
  const double acts = time_of_forces(domain, patch);
  add_holding(domain.grid, patch, own, to, [&](int node) {
    return -acts * (block.vector(node, force_at) + block.mass()[node] * domain.gravity);
  });
}

/// Impulses of walls and gravity on the nodes of a patch, once these and those beyond walls have
/// their increments.
template <int D>
void add_impulses(Domain<D>& domain, std::size_t p, const NodeBlock<D>& block, const double* own) {
  const Patch<D>& patch = domain.grid.patches[p];
  const double dt = time_of_forces(domain, patch);
  const auto& grid = domain.grid;
  const bool has_gravity = dot(domain.gravity, domain.gravity) > 0.0;
  Vector3 mass_moment = Vector3::zero();
  if (has_gravity) mass_moment = first_moment(grid, patch, block, own);
  if (has_gravity && patch.keeps) mass_moment += displaced_moment(block, own);
  if (patch.at_wall) {
    // What is left of the moment of folding (walls/reactions.hpp), by who owns the node beyond.
    const Reaction<D> walls = reaction_of(domain, p, &AngularImpulses::walls);
    add_folding(grid, patch, walls, [&](int node) {
      const double m = patch.counts(node) ? block.mass()[node] : 0.0;
      return m * (dt * domain.gravity - block.vector(node, increment_at));
    });
    if (grid.walls.absorb()) add_dashpots(grid, patch, block, own, dt, walls);
    if (grid.has_wall_springs) add_touching(grid, patch, block, own, dt, walls);
    // The mass of a node beyond a wall is with that of its image too.
    for_each_ghost_node(grid, patch, [&](int node, int image, const WallImage<D>&) {
      const double m = patch.counts(node) ? block.mass()[node] : 0.0;
      mass_moment += m * (place_of(grid, patch, node) - place_of(grid, patch, image));
    });
  }
  if (has_gravity)
    domain.sums[p].angular.gravity += dt * cross(mass_moment, in_space<D>(domain.gravity));
}

/// Eq. (8) for the nodes of a block, with the damping of its body, of which the sums are set.
template <int D>
NodeWork advance(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block,
                 const double* own, PatchSums<D>& sums) {
  const StepDamping damping = domain.damping_of(patch);
  const double acts = time_of_forces(domain, patch);
  if (!damping.acts()) return advance_block(block, own, domain.gravity, acts);
  const DampedWork damped = advance_damped_block(domain, patch, block, own, damping);
  sums.damping_first = damped.damping.first;
  sums.damping_second = damped.damping.second;
  sums.angular.damping += acts * damped.moment;
  if (domain.settles()) {
    sums.unbalanced = damped.unbalanced;
    sums.applied += damped.weight;  // to that of loads
  }
  return damped.done;
}

/// Of the mirrored weight over the time step [W]: it went into the force (ghost_weight, subtracted)
/// and is work of gravity, by the velocity of the image before the step.
template <int D>
Work work_of_mirrored_weight(const Domain<D>& domain, const Patch<D>& patch,
                             const NodeBlock<D>& block) {
  Work work;
  for_each_ghost_weight(domain, patch, block, [&](int image, int a, double weight) {
    const double dv = block.increment(a)[image];
    work.first += weight * (block.velocity(a)[image] - dv);
    work.second += weight * dv;
  });
  return work;
}

/// Hold the nodes of a patch at walls, and advance their velocities.
template <int D>
NodeWork hold_and_advance(Domain<D>& domain, std::size_t p) {
  auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const NodeBlock<D> block = grid.block(p);
  double own[BlockShape<D>::nodes_max];
  own_nodes(grid, patch, own);
  if (patch.at_wall)
    add_impulses_of_holding(domain, patch, block, own,
                            reaction_of(domain, p, &AngularImpulses::walls));
  hold_at_walls(domain, patch, block);
  return advance(domain, patch, block, own, domain.sums[p]);
}

/// What follows once all nodes of a patch have their velocities: nodes beyond walls, the ledger,
/// and the places of nodes in bodies.
template <int D>
void finish(Domain<D>& domain, std::size_t p, const NodeWork& done) {
  auto& grid = domain.grid;
  const double dt = domain.time_step;
  const bool absorb = grid.walls.absorb();
  const Patch<D>& patch = grid.patches[p];
  const NodeBlock<D> block = grid.block(p);
  double own[BlockShape<D>::nodes_max];
  own_nodes(grid, patch, own);
  PatchSums<D>& sums = domain.sums[p];
  Work loads, dashpots, push, friction;
  if (absorb && patch.at_wall) dashpots = work_of_dashpots(block, own, dt);
  if (grid.has_wall_springs && patch.at_wall) {
    push = work_of_faces(block, own, dt, true);
    friction = work_of_faces(block, own, dt, false);
  }
  const Work mirrored = work_of_mirrored_weight(domain, patch, block);
  const bool presses = domain.pool_of(patch).pressing.force >= 0;
  // Particles near a wall read nodes beyond it: positions by the velocity, eq. (16), velocities
  // by the increment, eq. (17).
  reflect_at_walls(grid, patch, block, velocity_at);
  reflect_at_walls(grid, patch, block, increment_at);
  if (domain.pool_of(patch).at.growth_limit >= 0) reflect_volumes(grid, patch, block);
  // After the reflection, as a piece may load a node beyond a wall: a force and a velocity that
  // are both turned do the same work as those of the image, which has the force.
  if (domain.has_loads()) loads = work_of_loads(domain, p);
  if (domain.has_body_forces()) loads += work_of_body_force(domain, p);
  if (presses) {
    const PressingWork work = work_of_pressing(domain, p);
    push += work.push;
    friction += work.rub;
  }
  // Nodes in bodies go with the new velocities all the step, others with the mean of both: what
  // is a half of the increments' work for these is all of it.
  const double halves = patch.keeps ? 2.0 : 1.0;
  loads.second *= halves;
  sums.damping_second *= halves;
  add_impulses(domain, p, block, own);
  // What is left is work of internal and contact forces; loads, walls and gravity have terms
  // of their own in the ledger, with the velocity in the middle of the step.
  sums.force_work = dt * (done.work + mirrored.first) - loads.first - dashpots.first - push.first -
                    friction.first;
  sums.load_first = loads.first;
  sums.load_second = loads.second;
  sums.dashpot_first = dashpots.first;
  sums.dashpot_second = dashpots.second;
  sums.wall_push = push;
  sums.wall_friction = friction;
  sums.gravity_first = dt * (done.gravity_first - mirrored.first);
  sums.gravity_second = 0.5 * halves * dt * (done.gravity_second - mirrored.second);
  if (!patch.keeps) return;
  add_work_of_surfaces(domain, p);
  count_kept_nodes(domain, move_kept_nodes(domain, patch, block, own, sums), sums);
  sums.kept_ahead -= 0.5 * shift_kept_nodes(domain, patch, block, own);
}

}  // namespace

/// Eq. (8), m_i dv_i = (f_i + m_i g) dt, with eq. (10) in the form m_i g: exact as gravity is
/// uniform, and no work for the particles. f_i holds the internal, contact and load
/// forces, and those of walls.
template <int D>
void advance_nodes(Domain<D>& domain) {
  for_each_patch(domain, prescribed, [&](std::size_t p) { advance_prescribed_nodes(domain, p); });
  for_each_patch(domain, deformable | free_rigid,
                 [&](std::size_t p) { finish(domain, p, hold_and_advance(domain, p)); });
  if (!has_kept_nodes(domain)) return;
  // Patches with nodes that follow others wait for these.
  std::vector<NodeWork>& done = domain.work_of_nodes;
  done.assign(domain.grid.patches.size(), {});
  const std::vector<std::uint8_t>& waits = patches_that_follow(domain);
  for_each_patch(domain, in_body, [&](std::size_t p) {
    done[p] = hold_and_advance(domain, p);
    if (!waits[p]) finish(domain, p, done[p]);
  });
  take_from_leading(domain, velocity_at);
  take_from_leading(domain, increment_at);
  for_each_patch(domain, in_body, [&](std::size_t p) {
    if (waits[p]) finish(domain, p, done[p]);
  });
}

template void advance_nodes<2>(Domain<2>&);
template void advance_nodes<3>(Domain<3>&);

}  // namespace mpm
