#pragma once
// The particles of a body in and around a tile, gathered once for all overlapped nodes of the tile.
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "mpm/contact/tile_holder.hpp"
#include "mpm/fields/lanes.hpp"
#include "mpm/particles/body.hpp"

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

/// A body's particles in the cells from which some of a tile's nodes are in reach.
template <int D>
class TileParticles {
 public:
  using T = Batch<contact_lanes<D>>;
  /// Empty places in the lanes repeat a particle of the cell and have no mass.
  struct Lanes {
    Vec<T, D> xi;  // position in the cell, in [0, 1]
    T half;        // half the particle's edge [cells]
    T mass;        // [kg]
  };

  /// Place of a cell's own node in the cell along each axis.
  double own_node() const { return own_node_; }

  /// Forget all and take what is around these nodes of another tile, a bit each by Tile<D>::cell.
  void gather(const TileGrid<D>& grid, const Body<D>& body, const Index<D>& tile,
              std::span<const TileHolder> holders, std::uint64_t nodes) {
    margin_ = grid.margin();
    own_node_ = node_in_cell(grid.basis);
    edge_ = Tile<D>::cells + 1 + margin_;
    patch_.fill(nullptr);
    for (const TileHolder& h : holders)
      patch_[static_cast<std::size_t>(Tile<D>::neighbours - 1 - h.neighbour)] =
          &grid.patches[static_cast<std::size_t>(h.patch)];
    cells_.assign(static_cast<std::size_t>(power(edge_, D)), {});
    wanted_.clear();
    for (; nodes != 0; nodes &= nodes - 1)
      for_each_cell_around(Tile<D>::cell_index(std::countr_zero(nodes)), [&](const Index<D>& cell) {
        Cell& c = cells_[number(cell)];
        if (c.wanted) return;
        c.wanted = true;
        wanted_.push_back(cell);
        fetch(body, cell);
      });
    lanes_.clear();
    for (const Index<D>& cell : wanted_) read(grid, body, grid.first_cell(tile), cell);
  }

  /// f(place, lanes) for the cells from which a node is in reach; `place` is the node's, as counted
  /// from the cell's own.
  template <class F>
  void around(const Index<D>& node, F&& f) const {
    for_each_cell_around(node, [&](const Index<D>& cell) {
      const Cell& c = cells_[number(cell)];
      if (c.begin == c.end) return;
      Index<D> place;
      for (std::size_t a = 0; a < D; ++a) place[a] = node[a] - cell[a];
      for (std::uint32_t i = c.begin; i < c.end; ++i) f(place, lanes_[i]);
    });
  }

 private:
  struct Cell {
    std::uint32_t begin = 0, end = 0;  // of lanes_
    bool wanted = false;
  };

  template <class F>
  void for_each_cell_around(const Index<D>& node, F&& f) const {
    Index<D> low, high;
    for (std::size_t a = 0; a < D; ++a) {
      low[a] = node[a] - 1;
      high[a] = node[a] + margin_;
    }
    for_each_index<D>(low, high, f);
  }
  /// Of a cell, by its coordinates from the tile's first.
  std::size_t number(const Index<D>& cell) const {
    int n = 0;
    for (std::size_t a = D; a-- > 0;) n = n * edge_ + cell[a] + 1;
    return static_cast<std::size_t>(n);
  }

  /// f(patch, number of the cell in its tile), if the body has a patch there.
  template <class F>
  void in_patch(const Index<D>& cell, F&& f) const {
    Index<D> tile, local;
    for (std::size_t a = 0; a < D; ++a) {
      tile[a] = cell[a] < 0 ? -1 : cell[a] >= Tile<D>::cells ? 1 : 0;
      local[a] = cell[a] - Tile<D>::cells * tile[a];
    }
    if (const Patch<D>* patch = patch_[static_cast<std::size_t>(Tile<D>::neighbour(tile))])
      f(*patch, static_cast<std::size_t>(Tile<D>::cell(local)));
  }

  /// Have the memory bring a cell's particles: they lie near their places in the sorted columns.
  void fetch(const Body<D>& body, const Index<D>& cell) const {
    in_patch(cell, [&](const Patch<D>& patch, std::size_t c) {
      if (!(patch.occupied >> c & 1u)) return;
      const std::uint32_t first = patch.begin + patch.cell_begin[c];
      const std::uint32_t last = patch.begin + patch.cell_begin[c + 1] - 1;
      const auto bring = [&](const auto* column) {
        __builtin_prefetch(column + first);
        __builtin_prefetch(column + last);
      };
      bring(body.order.data());
      for (int a = 0; a < D; ++a) bring(body.x(a));
      bring(body.mass());
      bring(body.volume());
    });
  }

  void read(const TileGrid<D>& grid, const Body<D>& body, const Index<D>& first,
            const Index<D>& cell) {
    constexpr int W = contact_lanes<D>;
    const CellCoordinates<D> coordinates = grid.coordinates();
    Cell& to = cells_[number(cell)];
    to.begin = static_cast<std::uint32_t>(lanes_.size());
    in_patch(cell, [&](const Patch<D>& patch, std::size_t c) {
      const std::uint32_t end = patch.cell_begin[c + 1];
      for (std::uint32_t i = patch.cell_begin[c]; i < end; i += W) {
        const LaneRows<W> rows(body.order.data() + patch.begin + i, end - i);
        Lanes& p = lanes_.emplace_back();
        for (int a = 0; a < D; ++a) {
          const auto k = static_cast<std::size_t>(a);
          p.xi[a] =
              local_coordinate(coordinates.in_cells(load(body.x(a), rows), a), first[k] + cell[k]);
        }
        p.mass = select(first_lanes<W>(rows.count), load(body.mass(), rows), T(0.0));
        p.half =
            T(0.5 / grid.cell_size) * particle_edge<D>(load(body.volume(), rows), body.mean_edge);
      }
    });
    to.end = static_cast<std::uint32_t>(lanes_.size());
  }

  int margin_ = 0;
  double own_node_ = 0.0;
  int edge_ = 0;  // cells along an edge of what is in reach
  std::array<const Patch<D>*, Tile<D>::neighbours> patch_{};  // by where its tile lies
  std::vector<Cell> cells_;
  std::vector<Index<D>> wanted_;
  std::vector<Lanes> lanes_;
};

}  // namespace mpm
