// The sums over the patches that hold a node. Every sum is taken by the one patch that owns the
// node, in the order of the tiles, so it depends on no thread (decision 0020). Ranks tell each
// other before what they have put there (decision 0056).
#include "mpm/grid/halo.hpp"
#include "mpm/grid/shared_nodes.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// Numbers [first, last) of the records, whole halves, which is how they are moved; with the forces
/// what walls have, which stands behind the records.
struct Exchanged {
  int first, last;
  bool forces;
};
constexpr Exchanged momenta{0, force_at, false}, forces{force_at, record, true},
    both{0, record, true};
// The mass is that of the first mapping and has been summed: a second time it would count each
// holder's share twice or more.
constexpr Exchanged remapped{remapped_at, record, false};

/// Ranks give what others read, as soon as it is there.
template <Exchanged what, int D>
void start(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  start_nodes(grid, what.first, what.last);
  if (what.forces) start_at_walls(grid);
  grid.partition.on_its_way = true;
}

template <Exchanged what, int D>
void exchange_nodes(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  if (!grid.partition.alone()) {
    if (!grid.partition.on_its_way) start<what>(domain);
    finish_nodes(grid, what.first, what.last);
    if (what.forces) finish_at_walls(grid);
    grid.partition.on_its_way = false;
  }
  sum_shared_nodes(grid, domain.threads, what.first, what.last, what.forces);
  if (what.forces) sum_shared_at_walls(grid, domain.threads);
}

}  // namespace

template <int D>
void start_momentum(Domain<D>& domain) {
  start<momenta>(domain);
}
template <int D>
void exchange_momentum(Domain<D>& domain) {
  exchange_nodes<momenta>(domain);
}

template <int D>
void start_forces(Domain<D>& domain) {
  start<forces>(domain);
}
template <int D>
void exchange_forces(Domain<D>& domain) {
  exchange_nodes<forces>(domain);
}

template <int D>
void start_momentum_and_forces(Domain<D>& domain) {
  start<both>(domain);
}
template <int D>
void exchange_momentum_and_forces(Domain<D>& domain) {
  exchange_nodes<both>(domain);
}

template <int D>
void start_remapped(Domain<D>& domain) {
  start<remapped>(domain);
}
template <int D>
void exchange_remapped(Domain<D>& domain) {
  exchange_nodes<remapped>(domain);
}

template void start_momentum<2>(Domain<2>&);
template void start_momentum<3>(Domain<3>&);
template void exchange_momentum<2>(Domain<2>&);
template void exchange_momentum<3>(Domain<3>&);
template void start_forces<2>(Domain<2>&);
template void start_forces<3>(Domain<3>&);
template void exchange_forces<2>(Domain<2>&);
template void exchange_forces<3>(Domain<3>&);
template void start_momentum_and_forces<2>(Domain<2>&);
template void start_momentum_and_forces<3>(Domain<3>&);
template void exchange_momentum_and_forces<2>(Domain<2>&);
template void exchange_momentum_and_forces<3>(Domain<3>&);
template void start_remapped<2>(Domain<2>&);
template void start_remapped<3>(Domain<3>&);
template void exchange_remapped<2>(Domain<2>&);
template void exchange_remapped<3>(Domain<3>&);

}  // namespace mpm
