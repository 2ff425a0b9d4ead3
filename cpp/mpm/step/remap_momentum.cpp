#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/scatter_momentum.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// The momenta of bodies of these kinds: m_i v_i' = sum N_ip m_p v_p with the new v_p (3.6, step
/// 10), that is m_i v_i + sum m_p N_ip dv_p. At a node of almost no mass the increment is so
/// weighed with the mass that particles bring (Sulsky, Zhou & Schreyer 1995).
template <int D>
void remap(Domain<D>& domain, Kinds kinds) {
  auto& grid = domain.grid;
  for_each_patch(domain, kinds, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    const Body<D>& body = domain.body_of(patch);
    // Over the increments, which all particles have taken. The mass stays: positions have not
    // changed since it was mapped.
    clear(block.records.at(remapped_at), block.count, half_record);
    if (body.is_prescribed()) return;
    if (body.deforms())
      scatter_by_transfer<gives_momentum>(domain, patch, block.records.at(remapped_at));
    else
      scatter<Mapping<Flip>, gives_momentum>(grid, body, domain.pool_of(patch), patch,
                                             block.records.at(remapped_at));
  });
}

}  // namespace

template <int D>
void remap_momentum(Domain<D>& domain) {
  remap(domain, deformable);
}

template <int D>
void remap_rigid_bodies(Domain<D>& domain) {
  // After they are held: only then are their velocities final. Those whose motion is prescribed
  // have their nodes cleared, and get their velocity in `find_remapped`.
  if (domain.has_rigid() || domain.has_prescribed()) remap(domain, free_rigid | prescribed);
}

template void remap_momentum<2>(Domain<2>&);
template void remap_momentum<3>(Domain<3>&);
template void remap_rigid_bodies<2>(Domain<2>&);
template void remap_rigid_bodies<3>(Domain<3>&);

}  // namespace mpm
