// As in the last step of Ma, Zhang & Huang 2010, section 3.5. The rest of their moving grid an
// unbounded one does not need; when to double is ours.
#include "mpm/run/coarsen_cells.hpp"

#include <limits>
#include <utility>

#include "mpm/contact/candidates.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/time_step.hpp"

namespace mpm {

template <int D>
bool must_coarsen(const Simulation<D>& simulation) {
  const TileGrid<D>& grid = simulation.domain.grid;
  const GridSettings& given = simulation.settings.grid;
  if (!given.coarsening || simulation.coarsenings >= most_coarsenings(given)) return false;
  const CoarseningSettings& coarsening = *given.coarsening;
  constexpr auto no_limit = std::numeric_limits<std::int64_t>::max();
  const bool many = std::cmp_greater(all_patches(grid), coarsening.tiles.value_or(no_limit));
  const bool large = std::cmp_greater(needed_bytes(grid), coarsening.bytes.value_or(no_limit));
  if (!many && !large) return false;
  for (int a = 0; a < D; ++a)
    if (grid.walls.exist && grid.walls.cells[static_cast<std::size_t>(a)] % 2 != 0) return false;
  return true;
}

/// A node of the new grid is one of the old grid, and the walls stay where they are. Between two
/// steps all mass, momentum and energy is the particles', so that none changes; what the coarser
/// grid then costs is in the numerical terms.
template <int D>
void coarsen_cells(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  TileGrid<D>& grid = domain.grid;
  ++simulation.coarsenings;
  const double before = kinetic_energy(domain);
  grid.cell_size *= 2.0;
  for (int& cells : grid.walls.cells) cells /= 2;
  release_nodes(grid);
  place_anchor(grid, domain.bodies, domain.pools);
  build_cell_lists(grid, domain.bodies, domain.pools, domain.threads, domain.list_scratch);
  for (Patch<D>& patch : grid.patches) patch.left_cell = true;  // what has just failed still leaves
  invalidate_pairs(domain.contact);
  if (domain.has_contact())
    connect_tiles(domain.contact, grid, domain.bodies, domain.contact_settings.response);
  // The affine part of velocities stays; its energy goes with the square of the cells.
  domain.ledger.set_kinetic(kinetic_energy(domain));
  domain.ledger.transferred += before - domain.ledger.kinetic;
  probe_speeds(domain);
  update_time_step(simulation);
}

template bool must_coarsen<2>(const Simulation<2>&);
template bool must_coarsen<3>(const Simulation<3>&);
template void coarsen_cells<2>(Simulation<2>&);
template void coarsen_cells<3>(Simulation<3>&);

}  // namespace mpm
