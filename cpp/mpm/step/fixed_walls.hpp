#pragma once
#include "mpm/domain.hpp"
#include "mpm/schedule/cell_loop.hpp"

namespace mpm {

/// Has a transfer another form where a fixed wall holds nodes of the particle?
template <class Transfer>
concept OtherAtFixedWalls = requires(const Transfer& transfer) { transfer.at_fixed_walls(); };

/// The transfer of each cell of a patch, and what particles at fixed walls take beyond the usual:
/// the wall gives it, so that it enters the balance of angular momentum (angular_ledger.hpp).
template <class Transfer, class T, int D>
class FixedWalls {
 public:
  FixedWalls(const Transfer& transfer, const TileGrid<D>& grid, const Patch<D>& patch,
             ParticlePool<D>& pool)
      : usual_(transfer), other_(other(transfer)) {
    if constexpr (OtherAtFixedWalls<Transfer>) {
      reach_ = grid.reach();
      walls_ = patch.at_wall ? &grid.walls : nullptr;
      for (int a = 0; a < D; ++a) {
        x_[a] = pool.x(a);
        v_[a] = pool.v(a);
      }
    }
  }

  const Transfer& transfer_of(const CellRange<D>& cell) {
    here_ = walls_ != nullptr && walls_->fixes_near(cell.cell, reach_.before, reach_.after);
    return here_ ? other_ : usual_;
  }
  /// Before their new velocities are stored. `dv` is the sum over the nodes, `of_grid` that of
  /// their velocities.
  template <class Rows>
  MPM_INLINE void add(const Rows& rows, const T& m, const Vec<T, D>& dv, const Vec<T, D>& of_grid) {
    if constexpr (OtherAtFixedWalls<Transfer>) {
      if (!here_) return;
      Vec<T, D> x, more;
      unrolled<D>([&](auto a) MPM_INLINE {
        const T v = load(v_[a], rows);
        x[a] = load(x_[a], rows);
        more[a] = m * (other_.take(v, dv[a], of_grid[a]) - usual_.take(v, dv[a], of_grid[a]));
      });
      for (int k = D == 2 ? 2 : 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        moment_[k] += x[a] * more[b] - x[b] * more[a];
      }
    }
  }
  void write(PatchSums<D>& sums) const {
    if constexpr (OtherAtFixedWalls<Transfer>)
      for (int k = 0; k < 3; ++k) sums.angular.mapped.c[k] += sum(moment_[k]);
  }

 private:
  static Transfer other(const Transfer& transfer) {
    if constexpr (OtherAtFixedWalls<Transfer>)
      return transfer.at_fixed_walls();
    else
      return transfer;
  }

  const Transfer usual_, other_;
  const Walls<D>* walls_ = nullptr;
  Reach reach_{};
  bool here_ = false;
  const double* x_[D] = {};
  const Storage* v_[D] = {};
  Vec<T, 3> moment_ = Vec<T, 3>::zero();
};

}  // namespace mpm
