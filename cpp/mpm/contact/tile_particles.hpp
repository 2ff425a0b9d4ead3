#pragma once
// The particles of a body in and around a tile, gathered once for all overlapped nodes of the tile.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mpm/contact/tile_holder.hpp"
#include "mpm/fields/lanes.hpp"
#include "mpm/particles/pool.hpp"

namespace mpm {

/// Edge length of a particle from its volume: the square root in 2D (unit thickness), the cube root
/// in 3D by Halley's iteration from the body's mean, to 1e-6 for volumes within a factor of ten of
/// it.
template <int D, class T>
T particle_edge(T volume, double mean_edge) {
  if constexpr (D == 2) {
    return sqrt(volume);
  } else {
    const T ratio = volume * T(1.0 / (mean_edge * mean_edge * mean_edge));
    // Halley's step for y^3 = ratio: y (y^3 + 2 ratio) / (2 y^3 + ratio), third order. Two are
    // enough within a factor of two of the mean (decision 0012). The third is chosen lane by lane,
    // so that an edge does not depend on the particles beside it.
    T y(1.0);
    const auto halley = [&](T z) {
      const T cube = z * z * z;
      return z * (cube + T(2.0) * ratio) / (T(2.0) * cube + ratio);
    };
    y = halley(halley(y));
    const auto far = (ratio < T(0.5)) | (ratio > T(2.0));
    if (any(far)) y = select(far, halley(y), y);
    return T(mean_edge) * y;
  }
}

/// The cells of the tile at an offset from which any of a tile's nodes is in reach; cells and nodes
/// a bit each by Tile<D>::cell. Along each axis a cell c reaches the nodes c - before to c + after.
template <int D>
std::uint64_t cells_in_reach(std::uint64_t nodes, const Index<D>& offset, const Reach& reach) {
  std::uint64_t cells = nodes;
  for (std::size_t a = 0; a < D; ++a) {
    const std::uint64_t along = std::exchange(cells, 0);
    // Node n is reached from the cells n - after to n + before, hence the signs. Axis by axis: a
    // box of shifts costs the sum of its edges, not their product.
    for (int k = -reach.after; k <= reach.before; ++k)  // as counted from the other tile's first
      cells |= Tile<D>::moved(along, a, k - Tile<D>::cells * offset[a]);
  }
  return cells;
}

/// A body's particles in the cells from which some of a tile's nodes are in reach.
template <int D>
class TileParticles {
 public:
  using T = Batch<contact_lanes>;
  /// Empty places in the lanes repeat a particle of the cell and have no mass.
  struct Lanes {
    Vec<T, D> xi;  // position in the cell, in [0, 1]
    T half;        // half the particle's edge [cells]
    T set_back;    // how far behind that its surface is [cells]
    T mass;        // [kg]
  };

  /// Cells from a tile that are gathered, if wanted.
  static constexpr int range_max = 2;

  /// Place of a cell's own node in the cell along each axis.
  double own_node() const { return reach_of(basis_).own_node; }
  /// Those of a cell that lie in a range of its pool's lists, the first of them.
  static Lanes lanes_of(const TileGrid<D>& grid, double mean_edge, const ParticlePool<D>& pool,
                        const Index<D>& cell, std::uint32_t begin, std::uint32_t end) {
    constexpr int W = contact_lanes;
    const CellCoordinates<D> coordinates = grid.coordinates();
    const LaneRows<W> rows(pool.order.data() + begin, end - begin);
    Lanes p;
    for (int a = 0; a < D; ++a)
      p.xi[a] = local_coordinate(coordinates.in_cells(load(pool.x(a), rows), a),
                                 cell[static_cast<std::size_t>(a)]);
    // Zero mass is how all that follows knows an empty lane.
    p.mass = select(first_lanes<W>(rows.count), load(pool.mass(), rows), T(0.0));
    p.half = T(0.5 / grid.cell_size) * particle_edge<D>(load(pool.volume(), rows), mean_edge);
    p.set_back = T(0.0);
    if (pool.set_back >= 0) p.set_back = p.half * load(pool.columns.component(pool.set_back), rows);
    return p;
  }

  /// No more particles than so many are around any node.
  std::size_t most_around() const { return lanes_.size() * T::lanes; }

  /// Have the memory bring what is around these nodes of a tile, a bit each by Tile<D>::cell.
  static void fetch(const TileGrid<D>& grid, const ParticlePool<D>& pool,
                    std::span<const TileHolder> holders, std::uint64_t nodes) {
    for_each_cell(
        grid, holders, nodes, grid.reach(),
        [&](const Patch<D>& patch, const Index<D>&, int cell) { fetch(pool, patch, cell); });
  }

  /// Forget all and take what is around these nodes of another tile.
  void gather(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
              const Index<D>& tile, std::span<const TileHolder> holders, std::uint64_t nodes) {
    gather(grid, body, pool, tile, holders, nodes, grid.reach());
  }
  /// Of the cells from which these would be in such a reach.
  void gather(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
              const Index<D>& tile, std::span<const TileHolder> holders, std::uint64_t nodes,
              const Reach& reach) {
    basis_ = grid.basis;
    lanes_.clear();
    filled_.fill(0);
    for_each_cell(grid, holders, nodes, reach,
                  [&](const Patch<D>& patch, const Index<D>& offset, int cell) {
                    Index<D> place = Tile<D>::cell_index(cell);
                    for (std::size_t a = 0; a < D; ++a) place[a] += Tile<D>::cells * offset[a];
                    read(grid, body.mean_edge, pool, grid.first_cell(tile), patch, cell, place);
                  });
  }

  /// f(shift, lanes) for all; `shift` + xi are positions from the tile's first node [cells].
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t w = 0; w < filled_.size(); ++w)
      for (std::uint64_t left = filled_[w]; left != 0; left &= left - 1) {
        const int n = static_cast<int>(64 * w) + std::countr_zero(left);
        Vec<double, D> shift;
        for (int a = 0, k = n; a < D; ++a, k /= edge)
          shift[a] = k % edge - before_tile - own_node();
        const Cell& c = cells_[static_cast<std::size_t>(n)];
        for (std::uint32_t i = c.begin; i < c.end; ++i) f(shift, lanes_[i]);
      }
  }
  /// f(shift, lanes) for the cells up to `range` from that of a point x, counted from the tile's
  /// first node [cells].
  template <class F>
  void within(const Vec<double, D>& x, int range, F&& f) const {
    Index<D> low, high;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      const int cell = static_cast<int>(std::floor(x[a] + own_node()));
      low[k] = std::max(cell - range, -before_tile);
      high[k] = std::min(cell + range, edge - before_tile - 1);
      if (low[k] > high[k]) return;
    }
    Index<D> first = low, last = high;
    last[0] = low[0];  // the cells of a row follow one another
    const int width = high[0] - low[0] + 1;
    for_each_index<D>(first, last, [&](Index<D> cell) {
      const int row = number(cell);
      std::uint64_t filled = bits_from(filled_.data(), row) & low_bits(width);
      for (; filled != 0; filled &= filled - 1) {
        const int k = std::countr_zero(filled);
        Vec<double, D> shift;
        for (int a = 0; a < D; ++a) shift[a] = cell[static_cast<std::size_t>(a)] - own_node();
        shift[0] += k;
        const Cell& c = cells_[static_cast<std::size_t>(row + k)];
        for (std::uint32_t i = c.begin; i < c.end; ++i) f(shift, lanes_[i]);
      }
    });
  }

  /// f(place, lanes) for the cells from which a node is in reach; `place` is the node's, as counted
  /// from the cell's own.
  template <class F>
  void around(const Index<D>& node, F&& f) const {
    const CellsAround& cells = around_[static_cast<std::size_t>(basis_)];
    // The cells around a node are rows of `width` bits; at most 27 in all fit into one word, and
    // cells without particles cost nothing (decision 0027).
    const int width = cells.width, own = number(node);
    std::uint64_t filled = 0;  // those with particles, a bit each
    for (int k = 0; k < power(width, D); k += width)
      filled |= (bits_from(filled_.data(), own + cells.number[k]) & low_bits(width)) << k;
    for (; filled != 0; filled &= filled - 1) {
      const int k = std::countr_zero(filled);
      const Cell& c = cells_[static_cast<std::size_t>(own + cells.number[k])];
      for (std::uint32_t i = c.begin; i < c.end; ++i) f(cells.place[k], lanes_[i]);
    }
  }

 private:
  struct Cell {
    std::uint32_t begin, end;  // of lanes_
  };
  // Cells that may be gathered: a tile's own, and some on each side.
  static constexpr int before_tile = std::max(Bases::after_max, range_max);
  static constexpr int edge = Tile<D>::cells + before_tile + std::max(Bases::before_max, range_max);
  static constexpr int cell_count = power(edge, D);

  /// The cells from which a node is in reach, the first axis fastest.
  struct CellsAround {
    static constexpr int most = power(Bases::before_max + Bases::after_max + 1, D);
    int width = 0;           // of them along an axis
    Index<D> place[most]{};  // the node's, as counted from the cell's own
    int number[most]{};      // the cell's, as counted from that of the node
  };
  static constexpr std::array<CellsAround, Bases::count> around_ = [] {
    std::array<CellsAround, Bases::count> all;
    for (std::size_t b = 0; b < all.size(); ++b) {
      CellsAround& cells = all[b];
      const Reach reach = reach_of(static_cast<BasisId>(b));
      cells.width = reach.before + reach.after + 1;
      for (int k = 0; k < power(cells.width, D); ++k)
        for (int a = 0, left = k, stride = 1; a < D; ++a, left /= cells.width, stride *= edge) {
          const int o = left % cells.width - reach.after;
          cells.place[k][static_cast<std::size_t>(a)] = -o;
          cells.number[k] += stride * o;
        }
    }
    return all;
  }();

  /// f(patch, offset of its tile, cell) for the cells with particles from which nodes of a tile are
  /// in reach.
  template <class F>
  static void for_each_cell(const TileGrid<D>& grid, std::span<const TileHolder> holders,
                            std::uint64_t nodes, const Reach& reach, F&& f) {
    for (const TileHolder& h : holders) {
      const Patch<D>& patch = grid.patches[static_cast<std::size_t>(h.patch)];
      // A holder says where the tile lies from its patch; offsets are numbered so that k and
      // neighbours - 1 - k are opposite.
      const Index<D> offset = Tile<D>::offset(Tile<D>::neighbours - 1 - h.neighbour);
      std::uint64_t cells = patch.cells() & cells_in_reach<D>(nodes, offset, reach);
      for (; cells != 0; cells &= cells - 1) f(patch, offset, std::countr_zero(cells));
    }
  }

  /// Of a cell, by its coordinates from the tile's first.
  static int number(const Index<D>& cell) {
    int n = 0;
    for (std::size_t a = D; a-- > 0;) n = n * edge + cell[a] + before_tile;
    return n;
  }

  /// Have the memory bring a cell's particles: they lie near their places in the sorted columns.
  static void fetch(const ParticlePool<D>& pool, const Patch<D>& patch, int cell) {
    const auto c = static_cast<std::size_t>(cell);
    const std::uint32_t first = patch.cell_begin[c], last = patch.cell_begin[c + 1] - 1;
    const auto bring = [&](const auto* column) {
      __builtin_prefetch(column + first);
      __builtin_prefetch(column + last);
    };
    // Both ends, for a cell's rows may lie across two cache lines (decision 0026).
    bring(pool.order.data() + patch.begin);
    for (int a = 0; a < D; ++a) bring(pool.x(a) + patch.first_row);
    bring(pool.mass() + patch.first_row);
    bring(pool.volume() + patch.first_row);
  }

  /// The particles of a patch's cell; `place` is that of the cell as counted from the tile's first.
  void read(const TileGrid<D>& grid, double mean_edge, const ParticlePool<D>& pool,
            const Index<D>& first, const Patch<D>& patch, int cell, const Index<D>& place) {
    const auto n = static_cast<std::size_t>(number(place)), c = static_cast<std::size_t>(cell);
    // Each cell is read once: tiles and patches of a body are one to one.
    filled_[n / 64] |= std::uint64_t{1} << n % 64;
    cells_[n].begin = static_cast<std::uint32_t>(lanes_.size());
    Index<D> in_grid = first;
    for (std::size_t a = 0; a < D; ++a) in_grid[a] += place[a];
    const std::uint32_t end = patch.begin + patch.cell_begin[c + 1];
    for (std::uint32_t i = patch.begin + patch.cell_begin[c]; i < end; i += T::lanes)
      lanes_.push_back(lanes_of(grid, mean_edge, pool, in_grid, i, end));
    cells_[n].end = static_cast<std::uint32_t>(lanes_.size());
  }

  BasisId basis_{};
  // A bit for each cell whose particles were taken; one word more, for rows that are read across
  // the end.
  std::array<std::uint64_t, cell_count / 64 + 2> filled_{};
  std::array<Cell, static_cast<std::size_t>(cell_count)> cells_;
  std::vector<Lanes> lanes_;
};

}  // namespace mpm
