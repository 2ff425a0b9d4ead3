#pragma once
// Transfers that are others where a fixed wall holds nodes of the particles.
#include <type_traits>

#include "mpm/step/transfer/transfer.hpp"

namespace mpm {

template <class Transfer>
concept OtherAtFixedWalls = requires(const Transfer& transfer) { transfer.at_fixed_walls(); };

/// The transfer of a cell's particles, which all reach the same nodes.
template <class Transfer, int D>
Transfer transfer_of_cell(const Transfer& transfer, const TileGrid<D>& grid, const Patch<D>& patch,
                          const std::type_identity_t<Index<D>>& cell) {
  if constexpr (OtherAtFixedWalls<Transfer>) {
    const Reach reach = grid.reach();
    if (patch.at_wall && grid.walls.fixes_near(cell, reach.before, reach.after))
      return transfer.at_fixed_walls();
  }
  return transfer;
}

/// Do particles take the velocity of the grid anywhere?
template <int D>
bool takes_of_grid(const Domain<D>& domain) {
  bool takes = grid_share(domain, any_share(domain)) > 0.0;
  with_transfer(domain, any_share(domain),
                [&]<class T>(const T&) { takes = takes || OtherAtFixedWalls<T>; });
  return takes;
}

/// The share of the grid's velocity in that which the particles take that reach a node at a wall.
// All that reach a node on a fixed wall or beyond one are in cells at it. Of a node beyond a slip
// wall some may be, near an edge where both meet: what they take more there is not counted.
template <int D>
double grid_share_at(const Domain<D>& domain, const Patch<D>& patch, int node) {
  const TransferShare of = share_of(domain, domain.pool_of(patch));
  double share = grid_share(domain, of);
  with_transfer(domain, of, [&]<class T>(const T& transfer) {
    if constexpr (OtherAtFixedWalls<T>) {
      Index<D> place = patch.shape.index(node);
      for (std::size_t a = 0; a < D; ++a) place[a] += domain.grid.first_cell(patch.tile)[a];
      if (domain.grid.walls.fixes_near(place, 0, 0))
        share = transfer.at_fixed_walls().take(0.0, 0.0, 1.0);
    }
  });
  return share;
}

}  // namespace mpm
