// The sums over the patches that hold a node.
#include "mpm/grid/shared_nodes.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

/// Of numbers [first, last) of the records; with the forces the dashpots.
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
