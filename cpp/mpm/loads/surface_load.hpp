#pragma once
// A load on a part of a body's surface: pieces of the surface, carried by the particles next to
// them.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mpm/loads/load_kinds.hpp"
#include "mpm/math/tensor.hpp"
#include "mpm/math/time_function.hpp"

namespace mpm {

template <int D>
Mat<double, D> cofactor(const Mat<double, D>& a) {
  Mat<double, D> r;
  if constexpr (D == 2) {
    r = {{{a[1][1], -a[1][0]}, {-a[0][1], a[0][0]}}};
  } else {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
        r[i][j] = a[k][m] * a[l][n] - a[k][n] * a[l][m];
      }
  }
  return r;
}

template <int D>
Vec<double, D> product(const Mat<double, D>& a, const Vec<double, D>& x) {
  Vec<double, D> r;
  for (int i = 0; i < D; ++i) {
    r[i] = a[i][0] * x[0];
    for (int j = 1; j < D; ++j) r[i] += a[i][j] * x[j];
  }
  return r;
}

/// Deformation gradient of a step, (1 - L/2)^-1 (1 + L/2), L the velocity gradient x time step
/// (Hughes & Winget 1980): of second order, and a rotation for a spin.
template <int D>
Mat<double, D> deformation(const Mat<double, D>& L) {
  Mat<double, D> minus, plus;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      plus[i][j] = 0.5 * L[i][j] + (i == j ? 1.0 : 0.0);
      minus[i][j] = -0.5 * L[i][j] + (i == j ? 1.0 : 0.0);
    }
  const Mat<double, D> adjugate = cofactor(minus);  // transposed
  const double inverse = 1.0 / determinant(minus);
  Mat<double, D> r;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      double sum = 0.0;
      for (int k = 0; k < D; ++k) sum += adjugate[k][i] * plus[k][j];
      r[i][j] = inverse * sum;
    }
  return r;
}

template <int D>
struct SurfaceLoad {
  std::string name;
  int body = 0;
  LoadKind kind{};
  std::array<TimeFunction, D> value;  // a number as the first [Pa]
  std::vector<std::uint32_t> piece;   // 1 + number of a particle's piece, in the user's order; or 0
  std::vector<Vec<double, D>> area;   // outward area vectors [m^2]
  std::vector<double> size;           // areas [m^2]: at an edge of the body more than |area|
  std::vector<Vec<double, D>> arm;    // from the particle to the middle of its piece [m]

  Vec<double, D> stress = Vec<double, D>::zero();   // mean of the value over the step [Pa]
  Vec<double, D> force = Vec<double, D>::zero();    // of the last step [N]
  Vec<double, D> impulse = Vec<double, D>::zero();  // so far [N s]

  Vec<double, D> force_on(std::size_t k) const {
    Vec<double, D> force = Vec<double, D>::zero();
    LoadKinds::with(
        kind, [&]<class Kind>(const Kind&) { force = Kind::force(stress, area[k], size[k]); });
    return force;
  }
  /// Take a piece along with its particle: da = cof(F) dA (Nanson), dx = F dX; L as above.
  void carry(std::size_t k, const Mat<double, D>& L) {
    const Mat<double, D> F = deformation(L);
    const double before = norm(area[k]);
    area[k] = product(cofactor(F), area[k]);
    if (before > 0.0) size[k] *= norm(area[k]) / before;
    arm[k] = product(F, arm[k]);
  }
};

}  // namespace mpm
