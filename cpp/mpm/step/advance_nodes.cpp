#include "mpm/loads/body_forces.hpp"
#include "mpm/loads/carry_loads.hpp"
#include "mpm/rigid/prescribed_bodies.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stages.hpp"
#include "mpm/walls/absorb.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {
namespace {

/// 1 at the nodes that a patch owns, 0 at those that another patch counts: as factors, so that the
/// loop over nodes has no branch and each shared node enters the ledger once.
template <int D>
void ownership(const Patch<D>& patch, int node_count, double* own) {
  for (int n = 0; n < node_count; ++n) own[n] = patch.owned[n] ? 1.0 : 0.0;
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

/// Sums over the nodes that a patch owns, with v before the step: A + B and G of the ledger, twice
/// S_g, all but for the time step, and sum m_i |dv_i|^2.
struct NodeWork {
  double work = 0.0, gravity_first = 0.0, gravity_second = 0.0, second = 0.0;
};

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
      done.second += own[n] * m * dv * dv;
      v += dv;
      numbers[increment_at + a] = dv;
    }
  }
  return done;
}

}  // namespace

/// Eq. (8), m_i dv_i = (f_i + m_i g) dt, with eq. (10) in the form m_i g: exact as gravity is
/// uniform, and no work for the particles. f_i holds the internal, contact, load and dashpot
/// forces.
template <int D>
void advance_nodes(Domain<D>& domain) {
  auto& grid = domain.grid;
  const double dt = domain.time_step;
  const bool absorb = grid.walls.absorb(), loaded = domain.has_loads();
  for_each_patch(domain, prescribed, [&](std::size_t p) { advance_prescribed_nodes(domain, p); });
  for_each_patch(domain, deformable | free_rigid, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    hold_at_walls(domain, patch, block);
    double own[BlockShape<D>::nodes_max];
    ownership(patch, block.count, own);
    // What moves beyond a wall is the image's: its mass and force have been folded there.
    for_each_ghost_node(grid, patch, [&](int node, int, const WallImage<D>&) { own[node] = 0.0; });
    const NodeWork done = advance_block(block, own, domain.gravity, dt);
    Work loads, dashpots;
    if (absorb && patch.at_wall) dashpots = work_of_dashpots(block, own, dt);
    // The mirrored weight went into the force (ghost_weight, subtracted); it is work of gravity, so
    // it is taken from there and put here. By the velocity of the image before the step.
    double weight_first = 0.0, weight_second = 0.0;
    for_each_ghost_weight(domain, patch, block, [&](int image, int a, double weight) {
      const double dv = block.increment(a)[image];
      weight_first += weight * (block.velocity(a)[image] - dv);
      weight_second += weight * dv;
    });
    // Particles near a wall read nodes beyond it: positions by the velocity, eq. (16), velocities
    // by the increment, eq. (17).
    reflect_at_walls(grid, patch, block, velocity_at);
    reflect_at_walls(grid, patch, block, increment_at);
    // After the reflection, as a piece may load a node beyond a wall: a force and a velocity that
    // are both turned do the same work as those of the image, which has the force.
    if (loaded) loads = work_of_loads(domain, p);
    if (domain.has_body_forces()) loads += work_of_body_force(domain, p);
    PatchSums<D>& sums = domain.sums[p];
    // What is left is work of internal and contact forces; loads, dashpots and gravity have terms
    // of their own in the ledger, with the velocity in the middle of the step.
    sums.force_work = dt * (done.work + weight_first) - loads.first - dashpots.first;
    sums.node_second = 0.5 * done.second;
    sums.load_first = loads.first;
    sums.load_second = loads.second;
    sums.dashpot_first = dashpots.first;
    sums.dashpot_second = dashpots.second;
    sums.gravity_first = dt * (done.gravity_first - weight_first);
    sums.gravity_second = 0.5 * dt * (done.gravity_second - weight_second);
  });
}

template void advance_nodes<2>(Domain<2>&);
template void advance_nodes<3>(Domain<3>&);

}  // namespace mpm
