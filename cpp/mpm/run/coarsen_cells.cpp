// The moving grid: where debris spreads, the cells double, as in the last step of Ma, Zhang & Huang
// 2010, section 3.5. The rest of theirs an unbounded grid does not need; when to double is ours.
#include <limits>
#include <utility>

#include "mpm/contact/candidates.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/run/simulation_of.hpp"

namespace mpm {

/// Whether the grid has more tiles or bytes than wanted, and its box can be cut into cells of twice
/// the size.
template <int D>
bool SimulationOf<D>::must_coarsen() const {
  const TileGrid<D>& grid = domain_.grid;
  if (!settings_.grid.coarsening || coarsenings_ >= most_coarsenings()) return false;
  const CoarseningSettings& coarsening = *settings_.grid.coarsening;
  constexpr auto no_limit = std::numeric_limits<std::int64_t>::max();
  const bool many = std::cmp_greater(grid.patches.size(), coarsening.tiles.value_or(no_limit));
  const bool large = std::cmp_greater(needed_bytes(grid), coarsening.bytes.value_or(no_limit));
  if (!many && !large) return false;
  for (int a = 0; a < D; ++a)
    if (grid.walls.exist && grid.walls.cells[static_cast<std::size_t>(a)] % 2 != 0) return false;
  return true;
}

/// Cells of twice the size about the same particles. A node of the new grid is one of the old grid,
/// and the walls stay where they are. Between two steps all mass, momentum and energy is the
/// particles', so that none changes; what the coarser grid then costs is in the numerical terms.
template <int D>
void SimulationOf<D>::coarsen_cells() {
  TileGrid<D>& grid = domain_.grid;
  ++coarsenings_;
  settings_.grid.cell_size *= 2.0;
  grid.cell_size = settings_.grid.cell_size;
  for (int& cells : grid.walls.cells) cells /= 2;
  release_nodes(grid);
  build_cell_lists(grid, domain_.bodies, domain_.pools, domain_.threads, domain_.list_scratch);
  for (Patch<D>& patch : grid.patches) patch.left_cell = true;  // what has just failed still leaves
  invalidate_pairs(domain_.contact);
  if (domain_.has_contact()) connect_tiles(domain_.contact, grid, domain_.bodies);
  probe_speeds();
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
