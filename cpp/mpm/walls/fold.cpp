// Nodes beyond walls that belong to mirrored bodies (decision 0010). Each patch folds what its own
// particles have given, before the exchange adds the images up: folding is linear, so the two may
// come in this order.
#include "mpm/step/stages.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {
namespace {

/// Of the vector at number `at` of the records.
template <int D>
void fold(Domain<D>& domain, int at) {
  auto& grid = domain.grid;
  if (!grid.has_ghosts()) return;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    fold_at_walls(grid, grid.patches[p], grid.block(p), at);
  });
}

}  // namespace

template <int D>
void fold_momentum(Domain<D>& domain) {
  fold(domain, momentum_at);
}

template <int D>
void fold_forces(Domain<D>& domain) {
  fold(domain, force_at);
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
