#pragma once
// The nodes that several patches hold: their lists are made when the blocks are cut, and every sum
// goes down them.
#include "mpm/grid/tile_grid.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {

/// Find the owners of nodes and list what they share, anew where blocks have changed.
template <int D>
void list_shared_nodes(TileGrid<D>& grid, Threads& threads);

/// Add up what the patches sharing a node have put there, for numbers [first, last) of the records,
/// half a record or a whole, always in the order of the tiles (of bonded bodies in one tile: of the
/// bodies); then every patch holds the sum. With `kept` those that keep their nodes as well, of
/// which the last half of these is summed: their first half is no sum, but what they keep.
template <int D>
void sum_shared_nodes(TileGrid<D>& grid, Threads& threads, int first, int last, bool kept = true);
/// The same for a number that stands beside the displacements of nodes that are kept.
template <int D>
void sum_kept_number(TileGrid<D>& grid, Threads& threads, int number);
/// The same for what walls need of the nodes, if they do: dashpots, springs.
template <int D>
void sum_shared_at_walls(TileGrid<D>& grid, Threads& threads);

/// f(node in p's block, node in q's block, count) for the rows of nodes that both hold.
template <int D, class F>
void for_each_shared_row(const Patch<D>& p, const Patch<D>& q, F&& f) {
  Index<D> low, high, shift;  // as p counts; `shift` to what q counts
  const Index<D> p_last = p.shape.last(), q_last = q.shape.last();
  for (std::size_t a = 0; a < D; ++a) {
    // Both count from the first node of their own tile.
    shift[a] = Tile<D>::cells * (p.tile[a] - q.tile[a]);
    low[a] = std::max(p.shape.low[a], q.shape.low[a] - shift[a]);
    high[a] = std::min(p_last[a], q_last[a] - shift[a]);
    if (low[a] > high[a]) return;
  }
  // Row by row along the first axis: nodes that follow one another in both blocks.
  const int p_first = p.shape.node(low), count = high[0] - low[0] + 1;
  Index<D> rows;
  for (std::size_t a = 0; a < D; ++a) {
    rows[a] = high[a] - low[a];
    low[a] += shift[a];
  }
  const int q_first = q.shape.node(low);
  for (int z = 0; z <= (D == 3 ? rows[D - 1] : 0); ++z)
    for (int y = 0; y <= rows[1]; ++y)
      f(p_first + (z * p.shape.nodes[1] + y) * p.shape.nodes[0],
        q_first + (z * q.shape.nodes[1] + y) * q.shape.nodes[0], count);
}

}  // namespace mpm
