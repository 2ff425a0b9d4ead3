#pragma once
// The motion of a rigid body by the laws of Newton and Euler.
#include <algorithm>
#include <array>
#include <limits>

#include "mpm/comm/all_sums.hpp"
#include "mpm/math/cholesky.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

using Vector3 = Vec<double, 3>;
using Matrix3 = Mat<double, 3>;

inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector3 operator*(const Matrix3& a, const Vector3& b) {
  return {dot(Vector3{a[0][0], a[0][1], a[0][2]}, b), dot(Vector3{a[1][0], a[1][1], a[1][2]}, b),
          dot(Vector3{a[2][0], a[2][1], a[2][2]}, b)};
}
inline Matrix3 transposed(const Matrix3& a) {
  Matrix3 r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[i][j] = a[j][i];
  return r;
}

/// Rotation by the vector `angle` [rad] (Rodrigues): R = 1 + sin [n]x + (1 - cos) [n]x^2, written
/// out with [n]x^2 = n n^T - 1. Without an angle n is 0, and R is 1 exactly.
inline Matrix3 rotation(const Vector3& angle) {
  const double size = norm(angle);
  const Vector3 n = normalised(angle);
  const double s = std::sin(size), c = 1.0 - std::cos(size);
  return {{{1.0 - c * (n[1] * n[1] + n[2] * n[2]), c * n[0] * n[1] - s * n[2],
            c * n[0] * n[2] + s * n[1]},
           {c * n[0] * n[1] + s * n[2], 1.0 - c * (n[0] * n[0] + n[2] * n[2]),
            c * n[1] * n[2] - s * n[0]},
           {c * n[0] * n[2] - s * n[1], c * n[1] * n[2] + s * n[0],
            1.0 - c * (n[0] * n[0] + n[1] * n[1])}}};
}

/// The box that particles lie in, in cells from the grid's origin.
struct Extent {
  static constexpr double far = std::numeric_limits<double>::max();
  double lower[3] = {far, far, far}, upper[3] = {-far, -far, -far};

  void add(int axis, double x) {
    lower[axis] = std::min(lower[axis], x);
    upper[axis] = std::max(upper[axis], x);
  }
  void add(const Extent& other) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], other.lower[a]);
      upper[a] = std::max(upper[a], other.upper[a]);
    }
  }
};

/// Mass, momentum, angular momentum and inertia of particles, about a point; and where they lie. In
/// 2D z is 0, so that of the inertia zz alone is that of the motion, and the spin has z alone.
struct RigidSums {
  double mass = 0.0;                   // [kg]
  Vector3 first = Vector3::zero();     // sum of m r [kg m]
  Vector3 momentum = Vector3::zero();  // [kg m/s]
  Vector3 angular = Vector3::zero();   // [kg m^2/s]
  Matrix3 inertia{};                   // [kg m^2]
  Extent extent;

  void add(double m, const Vector3& r, const Vector3& v) {
    mass += m;
    first += m * r;
    momentum += m * v;
    angular += m * cross(r, v);
    // I = sum m (r^2 1 - r r^T), of points: a particle alone has none.
    const double square = dot(r, r);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inertia[i][j] += m * ((i == j ? square : 0.0) - r[i] * r[j]);
  }
  /// f(number) for all that are sums, in one order: 1 + 3 (3 + 3) = 19.
  template <class F>
  void for_each(F&& f) {
    f(mass);
    for (int i = 0; i < 3; ++i) {
      f(first[i]);
      f(momentum[i]);
      f(angular[i]);
      for (int j = 0; j < 3; ++j) f(inertia[i][j]);
    }
  }
};

/// The sums over parts of a body, which depend on no order: exact, rounded once (decision 0038). So
/// are the extents, of which each is some particle's place.
class RigidTotal {
 public:
  void add(RigidSums part) {
    std::size_t k = 0;
    part.for_each([&](double x) { sums_[k++].add(x); });
    extent_.add(part.extent);
  }
  /// Of all ranks.
  void add_others(Comm& comm) {
    if (comm.alone()) return;
    all_sum(comm, sums_);
    double most[6];
    for (int a = 0; a < 3; ++a) {
      most[a] = -extent_.lower[a];
      most[3 + a] = extent_.upper[a];
    }
    comm.all_max(most);
    for (int a = 0; a < 3; ++a) {
      extent_.lower[a] = -most[a];
      extent_.upper[a] = most[3 + a];
    }
  }
  RigidSums value() const {
    RigidSums total;
    std::size_t k = 0;
    total.for_each([&](double& x) { x = sums_[k++].value(); });
    total.extent = extent_;
    return total;
  }

 private:
  std::array<ExactSum, 19> sums_;
  Extent extent_;
};

/// Give a row of particles, oblique to the axes, an inertia about its own line, about which it has
/// no angular momentum: I of rank two is made regular, and the solution of I w = L along the line
/// is 0. The line d is in the cofactors of I, which are mu_1 mu_2 d d^T.
inline void turn_no_line(double (&I)[3][3]) {
  double cofactors[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      cofactors[i][j] = I[a][c] * I[b][d] - I[a][d] * I[b][c];
    }
  const double determinant =
      I[0][0] * cofactors[0][0] + I[0][1] * cofactors[0][1] + I[0][2] * cofactors[0][2];
  const double trace = I[0][0] + I[1][1] + I[2][2];
  if (determinant > 1e-12 * trace * trace * trace) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) I[i][j] += cofactors[i][j] / trace;
}

/// Spin [rad/s] about the axes that are free, of an angular momentum and an inertia about the mass
/// centre: I w = L on the free axes, w = 0 on the others. An axis without inertia does not turn.
inline Vector3 spin_of(const Matrix3& inertia, const Vector3& angular, unsigned free_axes) {
  // Of a single particle, or of a row of them about their line along an axis, inertia is rounding.
  // In 2D xx and yy are not 0, but free_axes leaves these out.
  const double least = 1e-12 * (inertia[0][0] + inertia[1][1] + inertia[2][2]);
  double A[3][3], y[3];
  int turning = 0;
  for (int i = 0; i < 3; ++i) {
    const bool turns = (free_axes >> i & 1u) && inertia[i][i] > least;
    turning += turns ? 1 : 0;
    y[i] = turns ? angular[i] : 0.0;
    for (int j = 0; j < 3; ++j)
      // The row of an axis that does not turn is that of the unit matrix, with 0 on the right: one
      // solution of 3 x 3 for all cases.
      A[i][j] = turns && (free_axes >> j & 1u) && inertia[j][j] > least ? inertia[i][j]
                                                                        : (i == j ? 1.0 : 0.0);
  }
  if (turning == 3) turn_no_line(A);
  solve_symmetric(A, y);
  return {y[0], y[1], y[2]};
}

/// Where a rigid body is going in this step.
struct RigidMotion {
  Vector3 centre = Vector3::zero();    // of mass, at the start of the step [m]
  Vector3 velocity = Vector3::zero();  // of the centre [m/s]
  Vector3 spin = Vector3::zero();      // [rad/s]
  Matrix3 inertia{};                   // about the centre [kg m^2]
  unsigned free_axes = 7u;             // that it may turn about

  Vector3 velocity_at(const Vector3& x) const { return velocity + cross(spin, x - centre); }
};

/// A step's motion of a rigid body: the centre moves straight, the body turns by the spin of the
/// middle of the step, and its angular momentum stays (second-order accurate, after Simo & Wong
/// 1991, sec. 4). Returns the turn; `motion` becomes that of the end of the step.
inline Matrix3 turn(RigidMotion& motion, double time_step) {
  // L stays in space while the body's inertia turns with it: I = R I R^T. The spin at the half
  // step, I_half^-1 L, turns it for the whole step (explicit midpoint rule), which for a spin about
  // a principal axis is exact.
  const Vector3 angular = motion.inertia * motion.spin;
  const auto turned = [&](const Matrix3& R) { return R * motion.inertia * transposed(R); };
  const Matrix3 half = rotation((0.5 * time_step) * motion.spin);
  const Vector3 middle = spin_of(turned(half), angular, motion.free_axes);
  const Matrix3 whole = rotation(time_step * middle);
  motion.inertia = turned(whole);
  // From L again, so that L is kept for any number of steps and only the energy is not, which the
  // ledger counts (made_rigid).
  motion.spin = spin_of(motion.inertia, angular, motion.free_axes);
  // Straight: gravity and contact of the step are in the velocity already, as for particles, eq.
  // (16).
  motion.centre += time_step * motion.velocity;
  return whole;
}

}  // namespace mpm
