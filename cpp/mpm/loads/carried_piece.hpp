#pragma once
// Which nodes carry a force that acts on the surface beside a particle, and by how much.
#include <algorithm>
#include <array>

#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/weights.hpp"
#include "mpm/step/nodes_around.hpp"

namespace mpm {

/// The middle of a piece: where it is [m], and g(node, N) for the nodes that carry it.
template <class Place, class Nodes>
struct CarriedPiece {
  Place place;
  Nodes nodes;
};

/// By the functions of its particle, N_i + d . grad N_i + sum_k b_k d2N_i/dx_k^2, d the way from
/// there to the piece and b_k those of the basis: of all nodes that the particle gives mass to.
/// They sum to 1 and have the place of the piece for their mean.
template <int D, class B>
auto by_own_functions(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch,
                      const CellRange<D>& cell, std::uint32_t row, const Vec<double, D>& arm,
                      const B& basis) {
  std::array<AxisWeights<double, B::nodes>, D> w;
  Vec<double, D> xi, d, place;
  for (int a = 0; a < D; ++a) {
    const auto k = static_cast<std::size_t>(a);
    xi[a] = local_coordinate(grid.in_cells(pool.listed(a)[row], a), cell.cell[k]);
    w[k] = basis.along(xi[a]);
    // No further than the nodes beside the cell's own, as may be where a particle is stretched.
    const double u = xi[a] - B::own_node;
    d[a] = std::clamp(arm[a] / grid.cell_size, -1.0 - u, 1.0 - u);
    place[a] = grid.origin[a] + grid.cell_size * (cell.cell[k] + xi[a] - B::own_node + d[a]);
  }
  const Vec<double, D> b = second_order_of(basis, xi, d);
  const int first = cell.first_node;
  const BlockShape<D>& shape = patch.shape;
  const auto nodes = [=, &shape](auto&& g) {
    Index<D> low{}, high;
    high.fill(B::nodes - 1);
    for_each_index<D>(low, high, [&](Index<D> i) {
      const auto along = [&](std::size_t a) { return static_cast<std::size_t>(i[a]); };
      double N = 1.0;
      for (std::size_t a = 0; a < D; ++a) N *= w[a].N[along(a)];
      for (std::size_t a = 0; a < D; ++a) {
        const auto k = static_cast<int>(a);
        double more = d[k] * w[a].dN[along(a)] + b[k] * B::second_derivative[along(a)];
        for (std::size_t c = 0; c < D; ++c)
          if (c != a) more *= w[c].N[along(c)];
        N += more;
      }
      for (std::size_t a = 0; a < D; ++a) i[a] -= B::before;
      g(first + shape.distance(i), N);
    });
  };
  return CarriedPiece{place, nodes};
}

/// By the linear functions at the place of the piece, held between the nodes around its particle:
/// they have mass.
template <int D>
auto by_linear_functions(const TileGrid<D>& grid, const ParticlePool<D>& pool,
                         const Patch<D>& patch, const CellRange<D>& cell, std::uint32_t row,
                         const Vec<double, D>& arm) {
  const NodesAround<D> around(grid, pool, patch, cell, row);
  std::array<double, D> xi;
  Vec<double, D> place;
  for (std::size_t k = 0; k < D; ++k) {
    const auto a = static_cast<int>(k);
    const double x = around.place[a] - around.lower[k];
    xi[k] = std::clamp(x + arm[a] / grid.cell_size, 0.0, 1.0);
    place[a] = grid.origin[a] + grid.cell_size * (around.lower[k] + xi[k]);
  }
  const int first = around.first;
  const BlockShape<D>& shape = patch.shape;
  const auto nodes = [=, &shape](auto&& g) {
    for (int corner = 0; corner < Tile<D>::corners; ++corner) {
      double N = 1.0;
      for (std::size_t k = 0; k < D; ++k) N *= corner >> k & 1 ? xi[k] : 1.0 - xi[k];
      g(first + shape.corner_offset[static_cast<std::size_t>(corner)], N);
    }
  };
  return CarriedPiece{place, nodes};
}

/// f(piece): by its own functions where its basis has them for faces, else by linear ones.
template <int D, BasisModel B, class F>
void with_carried_piece(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch,
                        const CellRange<D>& cell, std::uint32_t row, const Vec<double, D>& arm,
                        const B& basis, F&& f) {
  if constexpr (ActsOnFaces<B>)
    f(by_own_functions(grid, pool, patch, cell, row, arm, basis));
  else
    f(by_linear_functions(grid, pool, patch, cell, row, arm));
}

}  // namespace mpm
