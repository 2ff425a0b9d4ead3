#pragma once
// Small symmetric systems.
#include <cmath>

namespace mpm {

/// Solve A z = y, A symmetric and positive definite with its lower triangle given, by Cholesky's
/// method in place: y becomes z.
template <int n>
void solve_symmetric(double (&A)[n][n], double (&y)[n]) {
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) A[j][j] -= A[j][k] * A[j][k];
    A[j][j] = std::sqrt(A[j][j]);
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) y[i] -= A[i][k] * y[k];
    y[i] /= A[i][i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) y[i] -= A[k][i] * y[k];
    y[i] /= A[i][i];
  }
}

}  // namespace mpm
