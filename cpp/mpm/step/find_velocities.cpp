// From the momenta that have been summed to velocities: v_i = p_i / m_i.
#include "mpm/rigid/prescribed_bodies.hpp"
#include "mpm/step/fixed_walls.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {
namespace {

/// The vector at number `at` of the records; `prescribed(body, patch, block)` for bodies that have
/// another.
template <int D, class F>
void find(Domain<D>& domain, int at, F&& prescribed) {
  auto& grid = domain.grid;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (patch.keeps) return;  // they have theirs
    const NodeBlock<D> block = grid.block(p);
    const Body<D>& body = domain.body_of(patch);
    if (body.is_prescribed()) {
      prescribed(body, patch, block);
      return;
    }
    // After the sums: momenta add up over patches, velocities do not. Then the images, which must
    // have theirs before nodes beyond walls take them.
    momentum_to_velocity(grid, patch, block, at);
    reflect_at_walls(grid, patch, block, at);
  });
}

/// f(patch, block, its reaction) for the patches at walls of bodies that take the velocity of the
/// grid, to count what walls change of their momenta; a part of it was counted when these were
/// folded.
template <int D, class F>
void for_each_mapped_at_walls(Domain<D>& domain, F&& f) {
  if (!takes_of_grid(domain)) return;
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (patch.at_wall)
      f(patch, domain.grid.block(p), reaction_of(domain, p, &AngularImpulses::mapped));
  });
}

/// Nodes that walls hold lose their momentum.
template <int D>
void add_reactions_held(Domain<D>& domain) {
  for_each_mapped_at_walls(
      domain, [&](const Patch<D>& patch, const NodeBlock<D>& block, const Reaction<D>& to) {
        double own[BlockShape<D>::nodes_max];
        own_nodes(domain.grid, patch, own);
        add_holding(domain.grid, patch, own, to, [&](int node) {
          return -grid_share_at(domain, patch, node) * block.vector(node, momentum_at);
        });
      });
}

/// Nodes beyond walls get the velocity of their images.
template <int D>
void add_reactions_beyond(Domain<D>& domain) {
  for_each_mapped_at_walls(
      domain, [&](const Patch<D>& patch, const NodeBlock<D>& block, const Reaction<D>& to) {
        add_folding(domain.grid, patch, to, [&](int node) {
          const double m = patch.counts(node) ? block.mass()[node] : 0.0;
          return -grid_share_at(domain, patch, node) * m * block.vector(node, velocity_at);
        });
      });
}

}  // namespace

template <int D>
void find_velocities(Domain<D>& domain) {
  add_reactions_held(domain);
  find(domain, velocity_at,
       [&](const Body<D>& body, const Patch<D>& patch, const NodeBlock<D>& block) {
         // That of the last step: in (6)-(7) a body has the velocity with which it arrives, in
         // (11)-(15) that of this step, so that contact pushes with what a change of speed takes
         // (docs/theory/motion.md).
         set_rigid_velocity(domain.grid, patch, block, body.motion->before);
       });
  add_reactions_beyond(domain);
}

template <int D>
void find_remapped(Domain<D>& domain) {
  find(domain, remapped_at, [](const Body<D>&, const Patch<D>&, const NodeBlock<D>& block) {
    // Of this step by now (advance_prescribed_nodes).
    for (int n = 0; n < block.count; ++n)
      for (int a = 0; a < D; ++a) block.remapped(a)[n] = block.velocity(a)[n];
  });
}

template void find_velocities<2>(Domain<2>&);
template void find_velocities<3>(Domain<3>&);
template void find_remapped<2>(Domain<2>&);
template void find_remapped<3>(Domain<3>&);

}  // namespace mpm
