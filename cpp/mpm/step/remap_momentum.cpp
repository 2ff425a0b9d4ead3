#include "mpm/schedule/scatter.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stages.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

/// The momenta of bodies of these kinds.
template <int D>
void remap(Domain<D>& domain, Kinds kinds) {
  auto& grid = domain.grid;
  for_each_patch(domain, kinds, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    const Body<D>& body = domain.body_of(patch);
    clear(block.records.at(remapped_at), block.count, half_record);
    if (body.is_prescribed()) return;
    with_transfer(domain, [&]<class Transfer>(const Transfer&) {
      scatter<Mapping<typename Transfer::Gives>, gives_momentum>(
          grid, body, domain.pool_of(patch), patch, block.records.at(remapped_at));
    });
  });
}

}  // namespace

template <int D>
void remap_momentum(Domain<D>& domain) {
  remap(domain, deformable);
}

template <int D>
void remap_rigid_bodies(Domain<D>& domain) {
  if (domain.has_rigid() || domain.has_prescribed()) remap(domain, free_rigid | prescribed);
}

template void remap_momentum<2>(Domain<2>&);
template void remap_momentum<3>(Domain<3>&);
template void remap_rigid_bodies<2>(Domain<2>&);
template void remap_rigid_bodies<3>(Domain<3>&);

}  // namespace mpm
