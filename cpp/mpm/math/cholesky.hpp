#pragma once
// Small symmetric systems.
#include "mpm/math/host_device.hpp"

namespace mpm {

/// Solve A z = y, A symmetric and positive definite with its lower triangle given, by Cholesky's
/// method without square roots (A = L D L^T) in place: y becomes z.
template <int n>
MPM_HD void solve_symmetric(double (&A)[n][n], double (&y)[n]) {
  // No pivoting: pivots of a positive definite system are positive in any order.
  double inverse[n];  // of D
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) {
      const double scaled = A[j][k];  // L D
      A[j][k] = scaled * inverse[k];
      A[j][j] -= scaled * A[j][k];
    }
    inverse[j] = 1.0 / A[j][j];
    for (int i = j + 1; i < n; ++i)
      for (int k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
  }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < i; ++k) y[i] -= A[i][k] * y[k];
  for (int i = n - 1; i >= 0; --i) {
    y[i] *= inverse[i];
    for (int k = i + 1; k < n; ++k) y[i] -= A[k][i] * y[k];
  }
}

}  // namespace mpm
