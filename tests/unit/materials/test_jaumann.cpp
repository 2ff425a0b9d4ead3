// The rotation of the Jaumann rate is a rotation, to second order the right one.
#include <random>

#include "check.hpp"
#include "mpm/materials/jaumann.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;

template <int D>
Mat<double, D> random_skew(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> any(-size, size);
  Mat<double, D> w{};
  for (int i = 0; i < D; ++i)
    for (int j = i + 1; j < D; ++j) {
      w[i][j] = any(random);
      w[j][i] = -w[i][j];
    }
  return w;
}

template <int D>
void check_cayley(mpm::testing::Report& report) {
  std::mt19937_64 random(2);
  for (const double size : {1e-8, 1e-3, 0.1, 1.0, 10.0})
    for (int n = 0; n < 50; ++n) {
      const auto w = random_skew<D>(random, size);
      const Mat<double, D> q = cayley(w);
      CHECK_CLOSE(determinant(q), 1.0, 32 * eps);
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) {
          double product = 0.0, left = 0.0, right = i == j ? 1.0 : 0.0;
          for (int k = 0; k < D; ++k) {
            product += q[i][k] * q[j][k];
            // (1 - w/2) q = 1 + w/2, the definition
            left += ((i == k ? 1.0 : 0.0) - 0.5 * w[i][k]) * q[k][j];
          }
          right += 0.5 * w[i][j];
          CHECK_CLOSE(product, i == j ? 1.0 : 0.0, 16 * eps);
          CHECK_CLOSE(left, right, 32 * eps * (1.0 + size));
        }
    }
}

/// A gradient on the configuration at the end: (1 + seen)(1 - L) = 1.
template <int D>
void check_seen_from_start(mpm::testing::Report& report) {
  Mat<double, D> L{}, inverse{};
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) L[i][j] = 0.07 * (i + 1) - 0.11 * j + 0.05 * i * j;
  Mat<double, D> F = seen_from_start(L);
  for (int i = 0; i < D; ++i) {
    F[i][i] += 1.0;
    for (int j = 0; j < D; ++j) inverse[i][j] = (i == j ? 1.0 : 0.0) - L[i][j];
  }
  const Mat<double, D> unit = F * inverse;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) CHECK_CLOSE(unit[i][j], i == j ? 1.0 : 0.0, 8 * eps);
}

/// A finite rotation R as one step, gradient R - 1, strains nothing up to the third order of its
/// angle.
template <int D>
double strain_of_rotation(double angle) {
  StrainIncrement<double, D> motion{};
  const double c = std::cos(angle), s = std::sin(angle);
  motion.gradient[0][0] = motion.gradient[1][1] = c - 1.0;
  motion.gradient[0][1] = -s;
  motion.gradient[1][0] = s;
  const auto strain = corotate(motion, Sym<double, D>::zero()).strain;
  return std::sqrt(inner(strain, strain));
}

template <int D>
void check_rotation(mpm::testing::Report& report) {
  const double coarse = strain_of_rotation<D>(0.02), fine = strain_of_rotation<D>(0.01);
  CHECK(coarse < 1e-6, coarse);
  CHECK(coarse >= 7.5 * fine, coarse, fine);
}

}  // namespace

void test_jaumann(mpm::testing::Report& report) {
  check_cayley<2>(report);
  check_cayley<3>(report);
  check_seen_from_start<2>(report);
  check_seen_from_start<3>(report);
  check_rotation<2>(report);
  check_rotation<3>(report);
}
