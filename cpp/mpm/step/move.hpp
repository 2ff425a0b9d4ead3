#pragma once
#include "mpm/domain.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/step/transfer/apic.hpp"

namespace mpm {

/// Moves particles of a patch, eq. (16), and notes whether any leaves its cell: only patches that
/// one has left are looked at when lists are mended (decision 0002).
/// Their affine part is carried along, after all that maps it at the places before: MUSL's remap.
template <class T, int D>
class Moving {
 public:
  Moving(const TileGrid<D>& grid, ParticlePool<D>& pool, double time_step)
      : time_step_(time_step), cells_(grid.coordinates()) {
    for (int a = 0; a < D; ++a) x_[a] = pool.x(a);
    if (pool.affine < 0) return;
    mass_ = pool.mass();
    half_moment_ = 0.5 * grid.affine_moment();
    if (pool.at.heat_owed >= 0) closes_ = Closing::as_it_would;
    for (int k = 0; k < D * D; ++k) affine_[k] = pool.affine_part(k);
  }

  /// `nodes` are the nodal fields of the cell, `w` what they want to know of the positions before.
  template <class Rows, class Field, class Weights>
  void move(const CellRange<D>& cell, const Rows& rows, const Field& nodes, const Weights& w) {
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
    if (mass_ != nullptr) carry_affine(rows);
  }
  /// Of all of them, when they have moved.
  void write(Patch<D>& patch, PatchSums<D>& sums) const {
    patch.left_cell = left_ != 0;
    sums.carried = half_moment_ * sum(lost_);
  }

 private:
  template <class Rows>
  MPM_INLINE void carry_affine(const Rows& rows) {
    Mat<T, D> C;
    unrolled<D * D>([&](auto k) MPM_INLINE { C[k / D][k % D] = load(affine_[k], rows); });
    const Mat<T, D> now = carried_along(C, T(time_step_), closes_);
    unrolled<D * D>([&](auto k) MPM_INLINE { store(affine_[k], rows, now[k / D][k % D]); });
    lost_ = fma(of_valid(rows, load(mass_, rows)), square_difference(C, now), lost_);
  }

  T lost_{0.0};  // by affine parts, over half of the moment
  double time_step_, half_moment_ = 0.0;
  const double* mass_ = nullptr;  // null without an affine part
  Closing closes_ = Closing::no_faster;
  std::uint64_t left_ = 0;  // lanes of which one has
  double* x_[D];
  CellCoordinates<D> cells_;
  Storage* affine_[D * D] = {};
};

}  // namespace mpm
