#pragma once
// A load on a part of a body's surface: pieces of the surface, carried by the particles next to
// them. A force at a point has pieces too: without an area vector, of which the size is the share.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mpm/loads/load_kinds.hpp"
#include "mpm/math/tensor.hpp"
#include "mpm/math/time_function.hpp"

namespace mpm {

/// Transpose of the adjugate: det(a) a^-T, also where a has no inverse. [i][j] without row i and
/// column j; by indices modulo 3 the signs come by themselves.
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
  // The inverse is the adjugate over the determinant; for a spin (1 - L/2) is never singular, as |1
  // - L/2| = 1 + |omega dt|^2 / 4.
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

/// A piece of the surface, carried by a particle.
template <int D>
struct SurfacePiece {
  int load = 0;                // that acts on it
  std::uint32_t particle = 0;  // number in the body
  std::uint32_t next = 0;      // 1 + number of the particle's next piece, of another load; or 0
  std::uint32_t unused = 0;    // in place of bytes of no value: pieces are kept as bytes
  double size = 0.0;           // area [m^2]: at an edge more than |area|; at a point a share
  Vec<double, D> area;         // outward area vector [m^2]
  Vec<double, D> arm;          // from the particle to the middle of the piece [m]
  // Of a body that keeps its nodes these three are as they were when its nodes were laid.

  /// As F takes it along with its particle: da = cof(F) dA (Nanson), dx = F dX.
  void deform(const Mat<double, D>& F) {
    // The size follows the vector's length: at an edge, where vectors of two sides have been added,
    // the size is larger than that, and no cofactor is its own. A share stays what it is.
    const double before = norm(area);
    area = product(cofactor(F), area);
    if (before > 0.0) size *= norm(area) / before;
    arm = product(F, arm);
  }

  /// By the deformation of a step; L as above.
  void carry(const Mat<double, D>& L) { deform(deformation(L)); }
};

template <int D>
struct SurfaceLoad {
  std::string name;
  int body = 0;
  LoadKind kind{};
  std::array<TimeFunction, D> value;  // a number as the first [Pa], at a point [N]

  Vec<double, D> mean = Vec<double, D>::zero();     // of the value over the step
  Vec<double, D> force = Vec<double, D>::zero();    // of the last step [N]
  Vec<double, D> impulse = Vec<double, D>::zero();  // so far [N s]

  Vec<double, D> force_on(const SurfacePiece<D>& piece) const {
    Vec<double, D> force = Vec<double, D>::zero();
    LoadKinds::with(
        kind, [&]<class Kind>(const Kind&) { force = Kind::force(mean, piece.area, piece.size); });
    return force;
  }
};

/// The piece on which a load acts of those that a particle carries, `first` being 1 + the number of
/// its first one, or 0; null if there is none.
template <int D>
SurfacePiece<D>* piece_of(std::vector<SurfacePiece<D>>& pieces, std::uint32_t first, int load) {
  for (std::uint32_t k = first; k != 0; k = pieces[k - 1].next)
    if (pieces[k - 1].load == load) return &pieces[k - 1];
  return nullptr;
}

}  // namespace mpm
