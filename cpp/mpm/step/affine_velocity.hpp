#pragma once
#include "mpm/domain.hpp"
#include "mpm/schedule/choose.hpp"

namespace mpm {

/// The affine part of particles' velocities, C_p = sum N_ip v_i (x_i - x_p) / D (Jiang et al.
/// 2015): found, stored, and its share of the energies.
template <class T, int D>
class TakingAffine {
 public:
  TakingAffine(const TileGrid<D>& grid, ParticlePool<D>& pool) {
    if (pool.affine < 0) return;
    for (int k = 0; k < D * D; ++k) columns_[k] = pool.affine_part(k);
    cell_size_ = grid.cell_size;
    to_column_ = grid.cell_size / grid.affine_moment();  // moments come in cells
    energy_ = grid.affine_moment();
  }

  /// Of the particles in the lanes; the velocity of the grid as well.
  template <class Field, class Rows, class W, class M, class Sums>
  MPM_INLINE void take(const Field& nodes, const Rows& rows, const W& w, const M& moments,
                       const T& m, Vec<T, D>& of_grid, Sums& sums) {
    nodes.template value_and_moments<velocity_at>(w, moments, of_grid, C_);
    T before(0.0), after(0.0);
    unrolled<D * D>([&](auto k) MPM_INLINE {
      const T C = C_[k / D][k % D] *= T(to_column_), old = load(columns_[k], rows);
      before = fma(old, old, before);
      after = fma(C, C, after);
      store(columns_[k], rows, C);
    });
    // Halved when written, as that of the velocity.
    const T scale = T(energy_) * m;
    sums.kinetic = fma(scale, after, sums.kinetic);
    sums.transferred = fma(scale, before - after, sums.transferred);
  }
  /// C h of those particles [m/s].
  MPM_INLINE Mat<T, D> in_cells() const {
    Mat<T, D> G;
    // As C h of the stored column, to the bit.
    unrolled<D * D>([&](auto k) MPM_INLINE { G[k / D][k % D] = T(cell_size_) * C_[k / D][k % D]; });
    return G;
  }

 private:
  double cell_size_ = 0.0, to_column_ = 0.0, energy_ = 0.0;
  Storage* columns_[D * D] = {};
  Mat<T, D> C_{};
};

}  // namespace mpm
