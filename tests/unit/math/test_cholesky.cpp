// Small symmetric systems against their own products.
#include <random>

#include "check.hpp"
#include "mpm/math/cholesky.hpp"

void test_cholesky(mpm::testing::Report& report) {
  constexpr int n = 4;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    double B[n][n], A[n][n], z[n], y[n];
    for (auto& row : B)
      for (double& b : row) b = any(random);
    for (double& x : z) x = any(random);
    for (int i = 0; i < n; ++i) {
      y[i] = 0.0;
      for (int j = 0; j < n; ++j) {
        A[i][j] = i == j ? 0.1 : 0.0;  // B B' + 0.1: positive definite, condition below 1e3
        for (int k = 0; k < n; ++k) A[i][j] += B[i][k] * B[j][k];
        y[i] += A[i][j] * z[j];
      }
    }
    mpm::solve_symmetric(A, y);
    for (int i = 0; i < n; ++i) CHECK_CLOSE(y[i], z[i], 1e-12);
  }
}
