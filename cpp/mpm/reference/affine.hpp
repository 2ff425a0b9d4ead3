#pragma once
// The affine part of a particle's velocity as the particle moves.
#include <algorithm>

#include "mpm/math/tensor.hpp"

namespace mpm::reference {

/// C -= dt sym(C C), without what would make energy as the symmetric part closes, and not where
/// dt C is no longer small.
template <int D>
void carry_along(Mat<double, D>& C, double dt) {
  Mat<double, D> S = C, square = C * C;
  double sum = 0.0, of_S = 0.0, cube = 0.0;
  for (int a = 0; a < D; ++a)
    for (int c = 0; c < D; ++c) {
      S[a][c] = (C[a][c] + C[c][a]) / 2;
      sum += C[a][c] * C[a][c];
      of_S += S[a][c] * S[a][c];
    }
  const Mat<double, D> of_closing = S * S;
  for (int a = 0; a < D; ++a)
    for (int c = 0; c < D; ++c) cube += S[a][c] * of_closing[a][c];
  const double x2 = dt * dt * sum / D, part = dt * std::max(1.0 - x2 * x2, 0.0);
  // Not of what closes slowly, which makes next to nothing: all from x^2 = 2e-5 on. The 1e5 is
  // 1 / closing_from of step/transfer/apic.hpp, written out on purpose.
  const double along = cube < 0.0 ? std::clamp(1e5 * x2 - 1.0, 0.0, 1.0) * cube / of_S : 0.0;
  for (int a = 0; a < D; ++a)
    for (int c = 0; c < D; ++c)
      C[a][c] -= part * ((square[a][c] + square[c][a]) / 2 - along * S[a][c]);
}

}  // namespace mpm::reference
