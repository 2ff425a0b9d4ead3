#pragma once
// The nodes that patches of several ranks hold: what each gives is told to the others before the
// shared nodes are summed, so that all add the same numbers in the same order.
#include "mpm/grid/tile_grid.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {

/// Find which nodes are exchanged with whom. Call when the blocks are cut.
template <int D>
void plan_halo(TileGrid<D>& grid);

/// Tell others what own patches have put into numbers [first, last) of the nodes that they read.
template <int D>
void start_nodes(TileGrid<D>& grid, int first, int last);
/// Put what they tell into the blocks of their patches.
template <int D>
void finish_nodes(TileGrid<D>& grid, int first, int last);
/// Both at once, and the sums of what patches share: numbers [first, last), half a record or a
/// whole.
template <int D>
void exchange_and_sum(TileGrid<D>& grid, Threads& threads, int first, int last);
/// The same for a number beside the displacements of nodes that are kept.
template <int D>
void exchange_and_sum_kept(TileGrid<D>& grid, Threads& threads, int number);
/// The same for what walls need of the nodes, if they do: dashpots, springs.
template <int D>
void start_at_walls(TileGrid<D>& grid);
template <int D>
void finish_at_walls(TileGrid<D>& grid);

}  // namespace mpm
