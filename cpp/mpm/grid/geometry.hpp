#pragma once
// Where cells, nodes and tiles are: from positions to their coordinates and back.
#include <cmath>
#include <utility>

#include "mpm/basis/basis.hpp"
#include "mpm/layout/tile.hpp"
#include "mpm/math/vec.hpp"
#include "mpm/walls/walls.hpp"

namespace mpm {

/// From positions to cells. Every kernel uses this one expression, so that all agree on cells.
template <int D>
struct CellCoordinates {
  Vec<double, D> origin;
  double cells_per_metre;

  template <class T>
  MPM_HD T in_cells(T x, int axis) const {
    return (x - T(origin[axis])) * T(cells_per_metre);
  }
};

/// Position within the cell, in [1e-12, 1 - 1e-12], from the position in cells and the cell's
/// coordinate. A particle exactly on a cell's face would give force to nodes to which it gives no
/// mass; it is held 1e-12 cells away.
template <class T>
MPM_HD T local_coordinate(T cells, double cell) {
  constexpr double from_face = 1e-12;
  return min(max(cells - T(cell), T(from_face)), T(1.0 - from_face));
}

template <int D>
struct GridGeometry {
  Vec<double, D> origin = Vec<double, D>::zero();  // position of node 0 [m]
  double cell_size = 0.0;                          // [m]
  BasisId basis = basis_id<Linear>;                // of all bodies
  // Cell at the lower corner of tile 0. Tied to the particles' first place, so that a problem
  // shifted by whole cells is cut into the same tiles and gives the same bits.
  Index<D> anchor{};
  Walls<D> walls;

  MPM_HD CellCoordinates<D> coordinates() const {
    Vec<double, D> corner = origin;
    // With GIMP and the quadratic B-spline a node lies amid its cell, so that all particles of a
    // cell reach the same 3^D nodes (decision 0022).
    for (int a = 0; a < D; ++a) corner[a] -= reach().own_node * cell_size;
    return {corner, 1.0 / cell_size};
  }
  /// Position along an axis in cells from the corner of cell 0.
  template <class T>
  MPM_HD T in_cells(T x, int axis) const {
    return coordinates().in_cells(x, axis);
  }
  /// The same from node 0: between which nodes it is.
  MPM_HD double among_nodes(double x, int axis) const {
    return CellCoordinates<D>{origin, 1.0 / cell_size}.in_cells(x, axis);
  }
  /// Cell coordinates of a position.
  MPM_HD Index<D> cell_of(const Vec<double, D>& x) const {
    const CellCoordinates<D> cells = coordinates();
    Index<D> i;
    for (int a = 0; a < D; ++a)
      i[a] = static_cast<std::int32_t>(std::floor(cells.in_cells(x[a], a)));
    return i;
  }
  /// Position of a node [m].
  MPM_HD Vec<double, D> position_of(const Index<D>& node) const {
    Vec<double, D> x;
    for (int a = 0; a < D; ++a) x[a] = origin[a] + cell_size * node[a];
    return x;
  }
  MPM_HD Index<D> tile_of(const Index<D>& cell) const {
    Index<D> t;
    for (int a = 0; a < D; ++a) {
      const int i = cell[a] - anchor[a];
      // Division rounded down, also for cells below the anchor, where particles may go later.
      t[a] = i >= 0 ? i / Tile<D>::cells : -((Tile<D>::cells - 1 - i) / Tile<D>::cells);
    }
    return t;
  }
  /// Coordinates of a tile's first cell, which are those of that cell's own node too.
  MPM_HD Index<D> first_cell(const Index<D>& tile) const {
    Index<D> c;
    for (int a = 0; a < D; ++a) c[a] = anchor[a] + tile[a] * Tile<D>::cells;
    return c;
  }

  /// The tile of a position and the number of its cell there. By the expression that all kernels
  /// use (CellCoordinates): a particle at a face must not be in one cell here and in the next one
  /// there.
  MPM_HD std::pair<Index<D>, int> tile_and_cell(const Vec<double, D>& x) const {
    const Index<D> cell = cell_of(x), tile = tile_of(cell);
    Index<D> local = first_cell(tile);
    for (std::size_t a = 0; a < D; ++a) local[a] = cell[a] - local[a];
    return {tile, Tile<D>::cell(local)};
  }

  /// D of APIC: sum over the nodes of N_i (x_i - x)^2 along an axis, the same at all places, [m^2];
  /// 0 where it is not.
  MPM_HD double affine_moment() const { return second_moment(basis) * cell_size * cell_size; }
  /// Nodes around a cell's own that its particles reach.
  MPM_HD Reach reach() const { return reach_of(basis); }
  /// Do nodes beyond walls follow their images before them?
  MPM_HD bool has_ghosts() const { return walls.exist && reach().before > 0; }
};

}  // namespace mpm
