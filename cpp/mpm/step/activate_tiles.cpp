#include "mpm/contact/candidates.hpp"
#include "mpm/contact/guests.hpp"
#include "mpm/contact/kept_planes.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {

namespace {

/// Which bodies may meet is a matter of tiles and of the blocks, so it holds until lists change.
/// `divided`: tiles have gone to other ranks, and what is kept of their contacts with them.
template <int D>
void connect_contact(Domain<D>& domain, bool divided) {
  Contact<D>& contact = domain.contact;
  const bool goes_along = divided && contact.cache.on;
  std::vector<KeptTile<D>> kept;
  if (goes_along) kept = kept_tiles(contact);
  connect_tiles(contact, domain.grid, domain.bodies, domain.contact_settings.response);
  if (goes_along) keep_tiles(contact, exchange_kept(kept, domain.grid.partition, false));
}

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
    // Whole tiles first: particles that stayed in their cells lie in the patch's tile, so that most
    // patches are settled without reading a particle.
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

/// Let ranks have other tiles where the work of one is much more than that of others.
template <int D>
void balance_ranks(Domain<D>& domain) {
  // Nodes that lie in bodies stay where they are.
  if (domain.grid.partition.alone() || has_kept_nodes(domain)) return;
  // Tiles have just been shared out; what contact costs is known after the first step.
  if (domain.step == 0 || (domain.step != 1 && domain.step % domain.balance_every != 0)) return;
  // The normals and gaps at a node take about as long as eight particles.
  constexpr std::int64_t of_node = 32;
  std::vector<TileCost<D>> costs;
  if (domain.has_contact())
    for (const ContactTile<D>& tile : domain.contact.tiles)
      if (tile.node_count > 0) costs.push_back({tile.tile, of_node * tile.node_count});
  share_out_anew<D>(domain.grid, domain.bodies, costs, domain.imbalance_limit);
}

/// Share out the patches by what they cost in a step: some four parts for a particle and one for a
/// node. Those of bodies whose motion is prescribed cost their nodes only.
template <int D>
void balance(Domain<D>& domain) {
  const auto& patches = domain.grid.patches;
  domain.threads.balance(patches.size(), [&](std::size_t p) {
    const double particles = domain.body_of(patches[p]).is_prescribed() ? 0.0 : patches[p].count;
    // Estimated: equal numbers of patches in place of this cost an example 1 %, so measured costs
    // have little to give (decision 0025). No result depends on it.
    return 4.0 * particles + patches[p].shape.node_count;
  });
}

}  // namespace

template <int D>
void activate_tiles(Domain<D>& domain) {
  // The sums are still those of the last step, of the same patches: what failed in its stress
  // update is taken out now, before anything is mapped, and its energy is that of the start of this
  // step (docs/theory/step.md, the energy ledger).
  for (std::size_t p = 0; p < domain.sums.size(); ++p)
    if (domain.sums[p].stress.eroded) domain.grid.patches[p].left_cell = true;
  if (domain.grid.outflow_box.exist) mark_leaving(domain);
  balance_ranks(domain);
  const bool divided = domain.grid.partition.divided;
  const bool changed = update_cell_lists(domain.grid, domain.bodies, domain.pools, domain.threads,
                                         domain.list_scratch, &domain.eroded, &domain.outflow);
  // When columns are sorted changes the speed alone: sums over a cell go by the particles' numbers,
  // not by their rows (decision 0033).
  if (divided) repack(domain.grid.patches, domain.bodies, domain.pools);
  sort_disordered(domain.grid, domain.bodies, domain.pools, domain.threads, domain.disorder,
                  domain.list_scratch);
  domain.sums.assign(domain.grid.patches.size(), {});
  domain.sums_of.clear();
  domain.rigid_at_walls = Vector3::zero();
  domain.rigid_at_faces = {};
  if (domain.grid.walls.exist) domain.face_parts.assign(domain.grid.patches.size(), {});
  if (changed && domain.has_contact()) connect_contact(domain, divided);
  if (domain.has_contact())
    exchange_guests(domain.contact, domain.grid, domain.bodies, domain.pools);
  balance(domain);
}

template void activate_tiles<2>(Domain<2>&);
template void activate_tiles<3>(Domain<3>&);

}  // namespace mpm
