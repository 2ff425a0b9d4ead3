#include "mpm/contact/candidates.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

namespace {

/// Mark the patches of which particles have left the region that is kept. A rigid body leaves as a
/// whole, with its mass centre; one whose motion is prescribed stays.
template <int D>
void mark_leaving(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  for (std::size_t k = 0; k < domain.rigid.size(); ++k) {
    Vec<double, D> centre;
    for (int a = 0; a < D; ++a) centre[a] = domain.rigid[k].centre[a];
    domain.bodies[domain.rigid_bodies[k]].leaves = !grid.outflow_box.holds(centre);
  }
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    Patch<D>& patch = grid.patches[p];
    const Body<D>& body = domain.body_of(patch);
    if (patch.left_cell) return;  // its particles are looked at anyway
    if (!body.deforms()) {
      patch.left_cell = body.leaves;
      return;
    }
    const Index<D> first = grid.first_cell(patch.tile);
    Vec<double, D> lower, upper;
    for (int a = 0; a < D; ++a) {
      lower[a] = grid.coordinates().origin[a] + first[a] * grid.cell_size;
      upper[a] = lower[a] + Tile<D>::cells * grid.cell_size;
    }
    if (grid.outflow_box.holds(lower, upper)) return;
    const ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch))
      if (!grid.outflow_box.holds(pool.position_of(row))) patch.left_cell = true;
  });
}

/// Share out the patches by what they cost in a step: some four parts for a particle and one for a
/// node. Those of bodies whose motion is prescribed cost their nodes only.
template <int D>
void balance(Domain<D>& domain) {
  const auto& patches = domain.grid.patches;
  domain.threads.balance(patches.size(), [&](std::size_t p) {
    const double particles = domain.body_of(patches[p]).is_prescribed() ? 0.0 : patches[p].count;
    return 4.0 * particles + patches[p].shape.node_count;
  });
}

}  // namespace

template <int D>
void activate_tiles(Domain<D>& domain) {
  for (std::size_t p = 0; p < domain.sums.size(); ++p)
    if (domain.sums[p].stress.eroded) domain.grid.patches[p].left_cell = true;
  if (domain.grid.outflow_box.exist) mark_leaving(domain);
  const bool changed = update_cell_lists(domain.grid, domain.bodies, domain.pools, domain.threads,
                                         domain.list_scratch, domain.eroded, domain.outflow);
  sort_disordered(domain.grid, domain.bodies, domain.pools, domain.threads, domain.disorder,
                  domain.list_scratch);
  domain.sums.assign(domain.grid.patches.size(), {});
  if (changed && domain.has_contact()) connect_tiles(domain.contact, domain.grid, domain.bodies);
  balance(domain);
}

template void activate_tiles<2>(Domain<2>&);
template void activate_tiles<3>(Domain<3>&);

}  // namespace mpm
