// Nodes beyond walls that belong to mirrored bodies (decision 0010). Each patch folds what its own
// particles have given, before the exchange adds the images up: folding is linear, so the two may
// come in this order.
#include "mpm/step/fixed_walls.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {
namespace {

/// Of the vector at number `at` of the records; with those of nodes in bodies, which map forces
/// alone.
template <int D>
void fold(Domain<D>& domain, int at, bool with_kept = false) {
  auto& grid = domain.grid;
  if (!grid.has_ghosts()) return;
  for_each_patch(domain, [&](std::size_t p) {
    if (with_kept || !grid.patches[p].keeps)
      fold_at_walls(grid, grid.patches[p], grid.block(p), at);
  });
}

/// What folding does to the vector at number `at` of the records, times factor(patch, node), into
/// the patches' sums; before it is folded.
template <int D, class F>
void add_reactions(Domain<D>& domain, Kinds kinds, int at, Vector3 AngularImpulses::* sum,
                   F&& factor) {
  auto& grid = domain.grid;
  if (!grid.has_ghosts()) return;
  for_each_patch(domain, kinds, [&](std::size_t p) {
    const NodeBlock<D> block = grid.block(p);
    const Patch<D>& patch = grid.patches[p];
    add_folding(grid, patch, reaction_of(domain, p, sum),
                [&](int node) { return factor(patch, node) * block.vector(node, at); });
  });
}

}  // namespace

template <int D>
void fold_momentum(Domain<D>& domain) {
  if (takes_of_grid(domain))
    add_reactions(
        domain, deformable, momentum_at, &AngularImpulses::mapped,
        [&](const Patch<D>& patch, int node) { return grid_share_at(domain, patch, node); });
  fold(domain, momentum_at);
}

template <int D>
void fold_forces(Domain<D>& domain) {
  add_reactions(domain, deformable | free_rigid | in_body, force_at, &AngularImpulses::walls,
                [&](const Patch<D>& patch, int) { return time_of_forces(domain, patch); });
  fold(domain, force_at, true);
  if (!domain.grid.has_ghosts()) return;
  for_each_flowing_patch(domain, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    fold_volumes(domain.grid, patch, block);
  });
}

template <int D>
void fold_remapped(Domain<D>& domain) {
  fold(domain, remapped_at);
}

template void fold_momentum<2>(Domain<2>&);
template void fold_momentum<3>(Domain<3>&);
template void fold_forces<2>(Domain<2>&);
template void fold_forces<3>(Domain<3>&);
template void fold_remapped<2>(Domain<2>&);
template void fold_remapped<3>(Domain<3>&);

}  // namespace mpm
