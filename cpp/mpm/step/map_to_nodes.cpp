#include "mpm/step/map_in_body.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/scatter_momentum.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/walls/mirror.hpp"

namespace mpm {
namespace {

/// The forces of a patch that keeps its nodes, which are all that it maps.
template <int D>
void map_kept_patch(Domain<D>& domain, std::size_t p) {
  const Patch<D>& patch = domain.grid.patches[p];
  const NodeBlock<D> block = domain.grid.block(p);
  const NodeRecords nodes = block.records;
  clear(nodes.at(force_at), block.count, half_record);
  // Their masses are the sums already, so that the owner of a node beyond a wall has all of it.
  for_each_ghost_weight(domain, patch, block,
                        [&](int image, int a, double weight) { block.force(a)[image] -= weight; });
  with_basis_and_lanes(
      domain.grid, domain.body_of(patch), patch, [&]<BasisModel B>(const B& basis, auto lanes) {
        if constexpr (B::nodes > 2)
          scatter_in_body<lanes>(basis, domain.grid, domain.pool_of(patch), patch, nodes);
      });
}

/// What a patch's particles give to its nodes.
template <unsigned what, int D>
void map_patch(Domain<D>& domain, std::size_t p) {
  if (domain.grid.patches[p].keeps) {
    if constexpr ((what & gives_forces) != 0) map_kept_patch(domain, p);
    return;
  }
  // With all three at once the bits are those of two stages, as each sum starts at 0 and has the
  // same terms in the same order (decision 0034).
  constexpr bool momentum = (what & gives_momentum) != 0;
  auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const NodeBlock<D> block = grid.block(p);
  if constexpr (momentum) {
    // All of all records: until now the memory may have been lent (NodeMemory::idle). Also of
    // bodies that map nothing, for the exchange reads every block.
    clear(block.records, block.count, record);
    if (grid.has_dashpots) clear(block.dashpots(), block.count, half_record);
    if (block.springs.data != nullptr) clear(block.springs, block.count, wall_record);
  }
  const Body<D>& body = domain.body_of(patch);
  if (body.is_prescribed() && !patch.in_contact) return;  // Nobody asks for its nodes.
  // The weights that "map momentum" leaves in the forces are added last, as where both are mapped
  // at once: to the same bits. For (0 + f) + w is not (w + f_1) + f_2 when rounded.
  const bool weighed = !momentum && patch.at_wall && grid.has_ghosts();
  double weights[BlockShape<D>::nodes_max][D];
  const auto for_each_weight = [&](auto&& f) {
    for (int n = 0; n < (weighed ? block.count : 0); ++n)
      for (int a = 0; a < D; ++a) f(weights[n][a], block.ghost_weight(a)[n]);
  };
  for_each_weight([](double& weight, double& force) { weight = std::exchange(force, 0.0); });
  // Every instance writes to this patch's block alone; nodes that others hold too are incomplete
  // until the exchange.
  if (body.deforms())
    scatter_by_transfer<what>(domain, patch, block.records);
  else if constexpr (momentum)  // It has no stress, and moves as FLIP does.
    scatter<Mapping<Flip>, what & ~gives_forces>(grid, body, domain.pool_of(patch), patch,
                                                 block.records);
  for_each_weight([](double weight, double& force) { force += weight; });
  // Now, as the mass is still what this patch's own particles gave. Gravity does not act on a body
  // whose motion is prescribed.
  if (momentum && !body.is_prescribed()) subtract_ghost_weight(domain, patch, block);
}

template <unsigned what, int D>
void map_to_nodes(Domain<D>& domain) {
  for_each_patch(domain, [&](std::size_t p) { map_patch<what>(domain, p); });
}

}  // namespace

template <int D>
void map_momentum(Domain<D>& domain) {
  map_to_nodes<gives_mass | gives_momentum>(domain);
}

template <int D>
void map_forces(Domain<D>& domain) {
  map_to_nodes<gives_forces>(domain);
}

template <int D>
void map_momentum_and_forces(Domain<D>& domain) {
  map_to_nodes<gives_mass | gives_momentum | gives_forces>(domain);
}

template void map_momentum<2>(Domain<2>&);
template void map_momentum<3>(Domain<3>&);
template void map_forces<2>(Domain<2>&);
template void map_forces<3>(Domain<3>&);
template void map_momentum_and_forces<2>(Domain<2>&);
template void map_momentum_and_forces<3>(Domain<3>&);

}  // namespace mpm
