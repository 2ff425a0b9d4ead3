// Symmetric tensors against the full matrices they stand for.
#include <random>

#include "check.hpp"
#include "mpm/math/tensor.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;

struct Samples {
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
  double number() { return uniform(random); }
  template <int D>
  Mat<double, D> matrix() {
    Mat<double, D> m;
    for (auto& row : m.c)
      for (double& x : row) x = number();
    return m;
  }
  template <int D>
  Sym<double, D> symmetric() {
    Sym<double, D> s;
    for (double& x : s.c) x = number();
    return s;
  }
};

/// The 3 x 3 matrix of a symmetric tensor: in 2D the yz and xz components are zero.
template <int D>
Mat<double, 3> full(const Sym<double, D>& s) {
  Mat<double, 3> m{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i == j || D == 3 || (i < 2 && j < 2)) m[i][j] = i == j ? s.c[i] : s(i, j);
  return m;
}

/// The 3 x 3 matrix of a deformation: in plane strain nothing happens along z.
template <int D>
Mat<double, 3> full(const Mat<double, D>& f) {
  Mat<double, 3> m{};
  m[2][2] = 1.0;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) m[i][j] = f[i][j];
  return m;
}

template <int D>
void check_tensors(mpm::testing::Report& report) {
  Samples samples;
  for (int n = 0; n < 100; ++n) {
    const auto a = samples.symmetric<D>(), b = samples.symmetric<D>();
    const auto f = samples.matrix<D>();
    const auto full_a = full(a), full_b = full(b), full_f = full(f);

    double product = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) product += full_a[i][j] * full_b[i][j];
    CHECK_CLOSE(inner(a, b), product, 18 * eps);  // 9 products of at most 1
    CHECK_EQUAL(inner(a, b), inner(b, a));

    double power = 0.0;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) power += full_a[i][j] * f[i][j];
    CHECK_CLOSE(inner(a, symmetric_part(f)), power, 18 * eps);

    Mat<double, 3> transposed;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) transposed[i][j] = full_f[j][i];
    const Mat<double, 3> expected = full_f * full_a * transposed;
    const auto moved = full(congruence(f, a));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) CHECK_CLOSE(moved[i][j], expected[i][j], 36 * eps);

    CHECK_CLOSE(determinant(f), determinant(full_f), 24 * eps);
    CHECK_CLOSE(determinant(f * f), determinant(f) * determinant(f), 400 * eps);
    CHECK_CLOSE(trace(symmetric_part(f)), inner(Sym<double, D>::isotropic(1.0), symmetric_part(f)),
                8 * eps);
  }
}

/// sqrt(J2) forms: 1 for uniaxial stress of 1, sqrt(3) for shear of 1, 0 for pressure.
template <int D>
void check_von_mises(mpm::testing::Report& report) {
  auto stress = Sym<double, D>::zero();
  stress.c[0] = 1.0;
  CHECK_CLOSE(von_mises(stress), 1.0, 4 * eps);
  stress = Sym<double, D>::zero();
  stress(0, 1) = 1.0;
  CHECK_CLOSE(von_mises(stress), std::sqrt(3.0), 4 * eps);
  CHECK_CLOSE(von_mises(Sym<double, D>::isotropic(3.0)), 0.0, 8 * eps);
}

}  // namespace

void test_tensor(mpm::testing::Report& report) {
  check_tensors<2>(report);
  check_tensors<3>(report);
  check_von_mises<2>(report);
  check_von_mises<3>(report);
  CHECK_EQUAL((Sym<double, 3>::index(1, 2)), 3);  // the order xx yy zz yz xz xy
  CHECK_EQUAL((Sym<double, 3>::index(0, 2)), 4);
  CHECK_EQUAL((Sym<double, 3>::index(0, 1)), 5);
  CHECK_EQUAL((Sym<double, 2>::index(1, 0)), 3);  // xx yy zz xy
}
