#pragma once
// F-bar over cells (Coombs et al. 2018, of de Souza Neto et al. 1996): in a cell the particles of a
// body change their volumes by one factor, the mean of their own, and the nodes get the mean of
// their pressures, which is the adjoint. So a cell has one constraint of volume and not one for
// each particle, and does not lock. Theory: docs/theory/step.md.
#include <cmath>

#include "mpm/domain.hpp"

namespace mpm {

/// Which particles take part in the means of their cells: all but those that bear no tension any
/// more, as their volumes hold voids.
template <int D>
class Averaged {
 public:
  explicit Averaged(const ParticlePool<D>& pool)
      : failed_(pool.at.failed >= 0 ? pool.columns.component(pool.at.failed) : nullptr) {}
  bool operator()(std::uint32_t row) const {
    return !failed_ || failed_[row] < static_cast<double>(FailureAction::no_tension);
  }

 private:
  const double* failed_;
};

/// det F of a step from its gradient x time step; of one on the configuration at its end
/// (decision 0047) the inverse of det F^-1.
template <int D>
double volume_factor(const Mat<double, D>& gradient, bool at_end) {
  Mat<double, D> f = gradient;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) f[i][j] = (i == j ? 1.0 : 0.0) + (at_end ? -1.0 : 1.0) * f[i][j];
  return at_end ? 1.0 / determinant(f) : determinant(f);
}

/// Means over a cell, by the volumes before the step: all of those that take part change by the
/// same factor, so the volumes after it have the same shares. One particle after another, in the
/// order of the lists, whatever the lanes.
template <int D>
struct CellMean {
  double volume = 0.0, factor = 0.0, dilation = 0.0;  // sums until `finish`

  void add(double V, const Mat<double, D>& gradient, bool at_end) {
    volume += V;
    factor += V * volume_factor(gradient, at_end);
    for (int a = 0; a < D; ++a) dilation += V * gradient[a][a];
  }
  void finish() {
    factor /= volume;
    dilation /= volume;
  }
};

/// F-bar = (J-bar / J)^(1/D) F: the gradient of a step, `at_end` of it or at its start, with the
/// mean change of volume. A particle that is turned inside out, or a cell that is, keeps its own:
/// the run stops at its volume.
template <int D>
Mat<double, D> averaged(const Mat<double, D>& gradient, double mean_factor, bool at_end) {
  const double ratio = mean_factor / volume_factor(gradient, at_end);
  if (!(ratio > 0.0)) return gradient;
  const double root = D == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
  // L-bar = r (1 + L) - 1, or of the end, where F^-1 = 1 - L: L-bar = 1 - (1 - L) / r.
  const double scale = at_end ? 1.0 / root : root, shift = at_end ? 1.0 - scale : scale - 1.0;
  Mat<double, D> mean;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) mean[i][j] = scale * gradient[i][j] + (i == j ? shift : 0.0);
  return mean;
}

/// What F-bar strains beyond the adjoint of what the nodes get, which is L + (tr L-bar - tr L) 1 /
/// D: of the second order in the step. Of the particles of a block; their stress does work on it.
template <int D>
struct StrainBeyond {
  Sym<double, D> of[MaterialBlock<D>::capacity];

  /// The work [J] of the stress that the nodal forces use.
  double work(const ParticlePool<D>& pool, const MaterialBlock<D>& block) const {
    const int at = pool.at.viscosity_pressure;
    const double* const q = at >= 0 ? pool.columns.component(at) : nullptr;
    double sum = 0.0;
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::uint32_t row = block.row[k];
      Sym<double, D> stress;
      for (int c = 0; c < Sym<double, D>::size; ++c)
        stress.c[c] = pool.stress(c)[row] - (q && c < D ? q[row] : 0.0);
      sum += pool.volume()[row] * inner(stress, of[k]);
    }
    return sum;
  }
};

/// Takes the means into the gradients of `count` particles of a block from place `first` on.
template <int D>
void average_gradients(MaterialBlock<D>& block, std::size_t first, int count,
                       const CellMean<D>& mean, const Averaged<D>& takes_part, bool at_end,
                       StrainBeyond<D>& beyond) {
  for (std::size_t k = first; k < first + static_cast<std::size_t>(count); ++k) {
    beyond.of[k] = Sym<double, D>::zero();
    if (!takes_part(block.row[k])) continue;
    Mat<double, D> own, change;
    double dilation = 0.0;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) own[i][j] = block.gradient[i][j][k];
      dilation += own[i][i];
    }
    const Mat<double, D> strained = averaged(own, mean.factor, at_end);
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) {
        change[i][j] = strained[i][j] - own[i][j];
        block.gradient[i][j][k] = strained[i][j];
      }
    for (int i = 0; i < D; ++i) change[i][i] -= (mean.dilation - dilation) / D;
    beyond.of[k] = symmetric_part(change);
  }
}

}  // namespace mpm
