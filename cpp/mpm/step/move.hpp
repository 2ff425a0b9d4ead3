#pragma once
#include "mpm/domain.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"

namespace mpm {

/// Moves particles of a patch, eq. (16), and notes whether any leaves its cell: only patches that
/// one has left are looked at when lists are mended (decision 0002).
template <int D>
class Moving {
 public:
  Moving(const TileGrid<D>& grid, ParticlePool<D>& pool, double time_step)
      : cells_(grid.coordinates()), time_step_(time_step) {
    for (int a = 0; a < D; ++a) x_[a] = pool.x(a);
  }

  /// `nodes` are the nodal fields of the cell, `w` what they want to know of the positions before.
  template <class Rows, class Field, class Weights>
  void move(const CellRange<D>& cell, const Rows& rows, const Field& nodes, const Weights& w) {
    using T = Batch<Rows::lanes>;
    // v_i at the end of the step, p_i / m_i of eq. (16) with the p_i of eq. (8). A field has one
    // value at a place, so that particles which follow it do not pass through each other; with
    // their own v_p they might.
    const Vec<T, D> velocity = nodes.template vector<velocity_at>(w);
    unrolled<D>([&](auto a) {
      const T x = fma(T(time_step_), velocity[a], load(x_[a], rows));
      store(x_[a], rows, x);
      // The expression that puts particles into cells (CellCoordinates), so that both agree to the
      // bit on who has left. A cell holds its lower face and not its upper one. Collected as bits,
      // without a branch; lanes behind the last particle repeat it and add nothing.
      const T local = cells_.in_cells(x, a) - T(cell.cell[a]);
      left_ |= lane_bits((local < T(0.0)) | (local >= T(1.0)));
    });
  }
  bool left_cell() const { return left_ != 0; }

 private:
  CellCoordinates<D> cells_;
  double* x_[D];
  double time_step_;
  std::uint64_t left_ = 0;  // lanes of which one has
};

}  // namespace mpm
