// Pieces of surfaces that go with their particles: Nanson's formula and rigid rotations.
#include <cmath>
#include <random>

#include "check.hpp"
#include "mpm/loads/surface_load.hpp"

namespace {

using namespace mpm;

template <int D>
Vec<double, D> any_vector(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Vec<double, D> r;
  for (int a = 0; a < D; ++a) r[a] = any(random);
  return r;
}

template <int D>
void check_loads(mpm::testing::Report& report) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 100; ++trial) {
    Mat<double, D> L, spin;
    for (int i = 0; i < D; ++i) {
      const Vec<double, D> row = any_vector<D>(random);
      for (int j = 0; j < D; ++j) L[i][j] = 0.1 * row[j];
    }
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) spin[i][j] = L[i][j] - L[j][i];
    const Vec<double, D> area = any_vector<D>(random), arm = any_vector<D>(random);
    SurfacePiece<D> piece, turned;
    for (SurfacePiece<D>* each : {&piece, &turned}) {
      each->area = area;
      each->arm = arm;
      each->size = 2.0 * norm(area);
    }
    // The volume of a prism grows by det F.
    piece.carry(L);
    const double J = determinant(deformation(L));
    CHECK_CLOSE(dot(piece.area, piece.arm), J * dot(area, arm), 1e-14);
    double trace = 0.0;
    for (int i = 0; i < D; ++i) trace += L[i][i];
    CHECK_CLOSE(J, std::exp(trace), 0.02);  // of second order in 0.1
    CHECK_CLOSE(piece.size, 2.0 * norm(piece.area), 1e-14);
    // A rotation changes no length and no angle.
    turned.carry(spin);
    CHECK_CLOSE(norm(turned.area), norm(area), 1e-14);
    CHECK_CLOSE(turned.size, 2.0 * norm(area), 1e-14);
    CHECK_CLOSE(norm(turned.arm), norm(arm), 1e-14);
    CHECK_CLOSE(dot(turned.area, turned.arm), dot(area, arm), 1e-14);
  }
}

}  // namespace

void test_surface_load(mpm::testing::Report& report) {
  check_loads<2>(report);
  check_loads<3>(report);
}
