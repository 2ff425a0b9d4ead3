// The sums over the patches that hold a node. Every sum is taken by the one patch that owns the
// node, in the order of the tiles, so it depends on no thread (decision 0020). Ranks tell each
// other before what they have put there (decision 0056).
#include "mpm/grid/halo.hpp"
#include "mpm/grid/shared_nodes.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

/// Of numbers [first, last) of the records, whole halves, which is how they are moved; with the
/// forces the dashpots, which stand behind the records.
template <int D>
void exchange(Domain<D>& domain, int first, int last, bool dashpots) {
  TileGrid<D>& grid = domain.grid;
  const bool absorbs = dashpots && grid.has_dashpots;
  if (!grid.partition.alone()) {
    exchange_nodes(grid, first, last);
    if (absorbs) exchange_dashpots(grid);
  }
  sum_shared_nodes(grid, domain.threads, first, last);
  if (absorbs) sum_shared_dashpots(grid, domain.threads);
}

}  // namespace

template <int D>
void exchange_momentum(Domain<D>& domain) {
  exchange(domain, 0, force_at, false);
}

template <int D>
void exchange_forces(Domain<D>& domain) {
  exchange(domain, force_at, record, true);
}

template <int D>
void exchange_momentum_and_forces(Domain<D>& domain) {
  exchange(domain, 0, record, true);
}

template <int D>
void exchange_remapped(Domain<D>& domain) {
  // The mass is that of the first mapping and has been summed: a second time it would count each
  // holder's share twice or more.
  exchange(domain, remapped_at, record, false);
}

template void exchange_momentum<2>(Domain<2>&);
template void exchange_momentum<3>(Domain<3>&);
template void exchange_forces<2>(Domain<2>&);
template void exchange_forces<3>(Domain<3>&);
template void exchange_momentum_and_forces<2>(Domain<2>&);
template void exchange_momentum_and_forces<3>(Domain<3>&);
template void exchange_remapped<2>(Domain<2>&);
template void exchange_remapped<3>(Domain<3>&);

}  // namespace mpm
