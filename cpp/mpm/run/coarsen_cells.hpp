#pragma once
// The moving grid: where debris spreads, the cells double.
#include "mpm/run/simulation.hpp"

namespace mpm {

inline int most_coarsenings(const GridSettings& grid) {
  return grid.coarsening ? grid.coarsening->times : 0;
}

/// Whether the grid has more tiles or bytes than wanted, and its box can be cut into cells of twice
/// the size.
template <int D>
bool must_coarsen(const Simulation<D>& simulation);

/// Cells of twice the size about the same particles.
template <int D>
void coarsen_cells(Simulation<D>& simulation);

}  // namespace mpm
