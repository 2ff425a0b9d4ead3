// The sums over the patches that hold a node. Every sum is taken by the one patch that owns the
// node, in the order of the tiles, so it depends on no thread (decision 0020). Here processes that
// hold parts of the patches would meet (decision 0034).
#include "mpm/grid/shared_nodes.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

/// Of numbers [first, last) of the records, whole halves, which is how they are moved; with the
/// forces the dashpots, which stand behind the records.
template <int D>
void exchange(Domain<D>& domain, int first, int last, bool dashpots) {
  sum_shared_nodes(domain.grid, domain.threads, first, last);
  if (dashpots && domain.grid.has_dashpots) sum_shared_dashpots(domain.grid, domain.threads);
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
