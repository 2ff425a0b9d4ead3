#include "mpm/schedule/scatter.hpp"
#include "mpm/step/mirror.hpp"
#include "mpm/step/stages.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

/// `scattered`: the particles of bodies that deform have given their momentum already.
template <int D>
void remap(Domain<D>& domain, bool scattered) {
  auto& grid = domain.grid;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    const Body<D>& body = domain.body_of(patch);
    if (!scattered || body.rigid) {
      clear(block.records.at(force_at), block.count, half_record);
      if (body.prescribed) return;
      with_transfer(domain, [&]<class Transfer>(const Transfer&) {
        scatter<Mapping<typename Transfer::Gives>, gives_momentum>(grid, body, patch,
                                                                   block.records.at(force_at));
      });
    }
    fold_at_walls(grid, patch, block, force_at);
  });
  grid.sum_shared_nodes(domain.threads, force_at, force_at + half_record);
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> block = grid.block(p);
    if (domain.body_of(grid.patches[p]).prescribed) {
      for (int n = 0; n < block.count; ++n)
        for (int a = 0; a < D; ++a) block.force(a)[n] = block.velocity(a)[n];
      return;
    }
    momentum_to_velocity(grid, grid.patches[p], block, force_at);
    reflect_at_walls(grid, grid.patches[p], block, force_at);
  });
}

}  // namespace

template <int D>
void remap_momentum(Domain<D>& domain) {
  remap(domain, false);
}

template <int D>
void remap_nodes(Domain<D>& domain) {
  remap(domain, true);
}

template void remap_momentum<2>(Domain<2>&);
template void remap_momentum<3>(Domain<3>&);
template void remap_nodes<2>(Domain<2>&);
template void remap_nodes<3>(Domain<3>&);

}  // namespace mpm
