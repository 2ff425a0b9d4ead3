#pragma once
// From the nodes of a patch, in the memory of a block of threads, to its particles: a thread a
// particle, with the bits of the host's fields (schedule/multilinear_field.hpp, nodal_field.hpp).
#include "mpm/step/transfer/apic.hpp"
#include "mpm/basis/basis.hpp"
#include "mpm/device/cuda/views.cuh"
#include "mpm/schedule/nodal_field.hpp"

namespace mpm {

/// The records of a patch's block, for a block of threads.
template <class B, int D>
struct BlockNodes {
  double numbers[Block<B, D>::nodes][record];

  /// By all threads, which then wait for each other.
  __device__ void load(const NodeTileView<D>& nodes, const std::int32_t* beside, bool first,
                       bool second) {
    for (int n = threadIdx.x; n < Block<B, D>::nodes; n += blockDim.x) {
      const Index<D> i = Block<B, D>::index(n);
      Index<D> offset, in_tile;
      for (int a = 0; a < D; ++a) {
        const int from_tile = i[a] + Block<B, D>::low;
        offset[a] = tile_offset<D>(from_tile);
        in_tile[a] = from_tile - offset[a] * Tile<D>::cells;
      }
      const std::int32_t tile = beside[Tile<D>::neighbour(offset)];
      const HalfRecord* from =
          reinterpret_cast<const HalfRecord*>(nodes.records) +
          2 * (std::size_t(tile) * NodeTileView<D>::nodes + Tile<D>::cell(in_tile));
      HalfRecord* to = reinterpret_cast<HalfRecord*>(numbers[n]);
      if (first) to[0] = from[0];
      if (second) to[1] = from[1];
    }
    __syncthreads();
  }
  __device__ NodeRecords from(const Index<D>& cell) { return {numbers[Block<B, D>::node(cell)]}; }
};

/// The fields of one cell as polynomials, for a basis of two nodes along an axis.
template <int D>
class CellPolynomials {
 public:
  __device__ CellPolynomials(const NodeRecords& own, const NodeStrides<D>& stride)
      : own_(own), stride_(stride) {}

  template <int at>
  __device__ Vec<double, D> vector(const Weights<double, D, 2>& w) const {
    Vec<double, D> v;
    unrolled<D>([&](auto i) { v[i] = Polynomial(*this, at + i).value(w.xi); });
    return v;
  }
  template <int at>
  __device__ std::array<Vec<double, D>, D> gradients(const Weights<double, D, 2>& w) const {
    std::array<Vec<double, D>, D> g;
    unrolled<D>([&](auto i) { g[i] = Polynomial(*this, at + i).gradient(w.xi); });
    return g;
  }

 private:
  /// Coefficients of one number of the nodes, and Horner's rule (MultilinearField).
  struct Polynomial {
    static constexpr int corners = 1 << D;
    double c[corners];

    __device__ Polynomial(const CellPolynomials& of, int number) {
      unrolled<corners>(
          [&](auto k) { c[k] = of.own_[of.stride_.to(k & 1, k >> 1 & 1, k >> 2)][number]; });
      unrolled<D>([&](auto a) {
        unrolled<corners>([&](auto k) {
          if constexpr ((k >> a & 1) != 0) c[k] = c[k] - c[k ^ 1 << a];
        });
      });
    }
    __device__ double line(int k, int l, double x) const { return fma(c[l], x, c[k]); }
    __device__ double value(const Vec<double, D>& xi) const {
      const auto bilinear = [&](int k) {
        return fma(xi[1], line(k + 2, k + 3, xi[0]), line(k, k + 1, xi[0]));
      };
      if constexpr (D == 2)
        return bilinear(0);
      else
        return fma(xi[2], bilinear(4), bilinear(0));
    }
    __device__ Vec<double, D> gradient(const Vec<double, D>& xi) const {
      if constexpr (D == 2)
        return {line(1, 3, xi[1]), line(2, 3, xi[0])};
      else
        return {fma(xi[2], line(5, 7, xi[1]), line(1, 3, xi[1])),
                fma(xi[2], line(6, 7, xi[0]), line(2, 3, xi[0])),
                fma(xi[1], line(6, 7, xi[0]), line(4, 5, xi[0]))};
    }
  };

  NodeRecords own_;
  NodeStrides<D> stride_;
};

template <class B, int D>
using DeviceField = std::conditional_t<B::nodes == 2, CellPolynomials<D>, NodalField<D, B::nodes>>;

/// A particle's cell, by its coordinates in the grid and in its patch's tile, and its place there.
template <int D>
struct InCell {
  Index<D> cell, in_tile;
  Vec<double, D> x, xi;  // x: in space [m]

  __device__ InCell(const CellCoordinates<D>& coordinates, const Index<D>& first_cell,
                    const ParticleView<D>& of, std::uint32_t row) {
    for (int a = 0; a < D; ++a) {
      x[a] = of.x[a][row];
      const double cells = coordinates.in_cells(x[a], a);
      cell[a] = static_cast<int>(::floor(cells));
      in_tile[a] = cell[a] - first_cell[a];
      xi[a] = local_coordinate(cells, cell[a]);
    }
  }
};

template <int D>
__device__ Vec<double, D> place_of_row(const ParticleView<D>& of, std::uint32_t row) {
  Vec<double, D> x;
  for (int a = 0; a < D; ++a) x[a] = of.x[a][row];
  return x;
}

/// Note where a particle at x belongs, and take a turn there.
template <int D>
__device__ bool find_target(const GridGeometry<D>& grid, const CellCoordinates<D>& coordinates,
                            const ListView<D>& lists, std::size_t patch, std::uint32_t entry,
                            const Vec<double, D>& x, const AnIndex<D>& cell_before,
                            const MoveView& moves) {
  const Index<D> tile = lists.tile[patch], first = grid.first_cell(tile);
  Index<D> offset, in_tile, other = tile;
  bool left = false, near = true;
  for (int a = 0; a < D; ++a) {
    const int cell = static_cast<int>(::floor(coordinates.in_cells(x[a], a)));
    left = left || cell != cell_before[a];
    offset[a] = tile_offset<D>(cell - first[a]);
    in_tile[a] = cell - first[a] - offset[a] * Tile<D>::cells;
    other[a] += offset[a];
    near = near && offset[a] >= -1 && offset[a] <= 1;
  }
  std::int32_t to = -1;
  if (near) to = lists.patch_beside[patch * Tile<D>::neighbours + Tile<D>::neighbour(offset)];
  if (to < 0) {
    moves.target[entry] = MoveView::homeless;
    const std::uint32_t k = atomicAdd(moves.homeless_count, 1u);
    if (k < moves.homeless_room)
      moves.homeless_keys[k] =
          TileKey<D>::holds(other) ? TileKey<D>::of(lists.body[patch], other) : ~std::uint64_t{0};
    return true;
  }
  const std::uint32_t target = static_cast<std::uint32_t>(to) * Tile<D>::cell_count +
                               static_cast<std::uint32_t>(Tile<D>::cell(in_tile));
  moves.target[entry] = target;
  moves.slot[entry] = atomicAdd(moves.counts + target, 1u);
  return left;
}

/// The affine part as it is carried along: the expression of Moving on the host. Returns the kinetic
/// energy over half of D that it loses.
template <int D>
__device__ double carry_affine(const ParticleView<D>& of, std::uint32_t row, double time_step) {
  Mat<double, D> C;
  for (int k = 0; k < D * D; ++k) C[k / D][k % D] = of.affine[k][row];
  // Gases, which would close as they do, are not on a device.
  const Mat<double, D> now = carried_along(C, time_step, Closing::no_faster);
  for (int k = 0; k < D * D; ++k) of.affine[k][row] = now[k / D][k % D];
  return of.mass[row] * square_difference(C, now);
}

/// Eq. (16), and the list that the particle belongs to from now on: the expression of Moving on the
/// host. `velocity` is that of the advanced nodes at its place before. Has it left its cell?
template <int D>
__device__ bool move_particle(const GridGeometry<D>& grid, const CellCoordinates<D>& coordinates,
                              const ListView<D>& lists, const ParticleView<D>& of,
                              std::size_t patch, std::uint32_t entry, std::uint32_t row,
                              const InCell<D>& before, const Vec<double, D>& velocity,
                              double time_step, const MoveView& moves) {
  Vec<double, D> x;
  for (int a = 0; a < D; ++a) of.x[a][row] = x[a] = fma(time_step, velocity[a], before.x[a]);
  return find_target(grid, coordinates, lists, patch, entry, x, before.cell, moves);
}

}  // namespace mpm
