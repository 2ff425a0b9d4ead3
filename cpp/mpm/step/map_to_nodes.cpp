#include "mpm/schedule/scatter.hpp"
#include "mpm/step/absorb.hpp"
#include "mpm/step/loads.hpp"
#include "mpm/step/mirror.hpp"
#include "mpm/step/prescribed_bodies.hpp"
#include "mpm/step/stages.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

/// What a patch's particles give to its nodes.
template <unsigned what, int D>
void map_patch(Domain<D>& domain, std::size_t p) {
  constexpr bool momentum = (what & gives_momentum) != 0, forces = (what & gives_forces) != 0;
  auto& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const NodeBlock<D> block = grid.block(p);
  if constexpr (momentum) {
    // All of all records: until now the memory may have been lent (TileGrid::idle_memory).
    clear(block.records, block.count, record);
    if (grid.has_dashpots) clear(block.dashpots(), block.count, half_record);
  }
  const Body<D>& body = domain.body_of(patch);
  if (body.prescribed && !patch.in_contact) return;  // Nobody asks for its nodes.
  // The weights that "map momentum" leaves in the forces are added last, as where both are mapped
  // at once: to the same bits.
  const bool weighed = !momentum && patch.at_wall && grid.has_ghosts();
  double weights[BlockShape<D>::nodes_max][D];
  const auto for_each_weight = [&](auto&& f) {
    for (int n = 0; n < (weighed ? block.count : 0); ++n)
      for (int a = 0; a < D; ++a) f(weights[n][a], block.force(a)[n]);
  };
  for_each_weight([](double& weight, double& force) { weight = std::exchange(force, 0.0); });
  with_transfer(domain, [&]<class Transfer>(const Transfer&) {
    using Gives = Mapping<typename Transfer::Gives>;
    if (!body.rigid)
      scatter<Gives, what>(grid, body, patch, block.records);
    else if constexpr (momentum)  // It has no stress.
      scatter<Gives, what & ~gives_forces>(grid, body, patch, block.records);
  });
  for_each_weight([](double weight, double& force) { force += weight; });
  if constexpr (momentum) {
    if (!body.prescribed) subtract_ghost_weight(domain, patch, block);
    fold_at_walls(grid, patch, block, velocity_at);
  }
  if (!forces || body.rigid) return;
  if (grid.walls.absorb()) scatter_dashpots(grid, body, patch, block);
  if (domain.has_loads()) scatter_loads(domain, p);
  fold_at_walls(grid, patch, block, force_at);
}

/// From the momenta that have been summed to velocities.
template <int D>
void find_velocities(Domain<D>& domain, std::size_t p) {
  auto& grid = domain.grid;
  const NodeBlock<D> block = grid.block(p);
  const Body<D>& body = domain.body_of(grid.patches[p]);
  if (body.prescribed) {
    set_rigid_velocity(grid, grid.patches[p], block, body.motion->before);
    return;
  }
  momentum_to_velocity(grid, grid.patches[p], block, velocity_at);
  reflect_at_walls(grid, grid.patches[p], block, velocity_at);
}

template <unsigned what, int D>
void map_to_nodes(Domain<D>& domain) {
  constexpr bool momentum = (what & gives_momentum) != 0, forces = (what & gives_forces) != 0;
  auto& grid = domain.grid;
  const bool loaded = forces && domain.has_loads();
  if (loaded) start_loads(domain);
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) { map_patch<what>(domain, p); });
  grid.sum_shared_nodes(domain.threads, momentum ? 0 : force_at, forces ? record : force_at);
  if (forces && grid.has_dashpots) grid.sum_shared_dashpots(domain.threads);
  if (momentum)
    domain.threads.for_each(grid.patches.size(),
                            [&](std::size_t p) { find_velocities(domain, p); });
  if (loaded) sum_loads(domain);
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

template <int D>
void absorb_at_walls(Domain<D>& domain) {
  auto& grid = domain.grid;
  if (!grid.walls.absorb()) return;
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    add_dashpot_forces(grid.patches[p], grid.block(p), domain.gravity, domain.time_step);
  });
}

template void map_momentum<2>(Domain<2>&);
template void map_momentum<3>(Domain<3>&);
template void map_forces<2>(Domain<2>&);
template void map_forces<3>(Domain<3>&);
template void map_momentum_and_forces<2>(Domain<2>&);
template void map_momentum_and_forces<3>(Domain<3>&);
template void absorb_at_walls<2>(Domain<2>&);
template void absorb_at_walls<3>(Domain<3>&);

}  // namespace mpm
