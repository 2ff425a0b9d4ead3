// Rotations, inertia and the free turning of a rigid body, against closed forms.
#include <numbers>
#include <random>

#include "check.hpp"
#include "mpm/rigid/rigid_motion.hpp"

namespace {

using namespace mpm;

double distance(const Vector3& x, const Vector3& y) { return norm(x - y); }

}  // namespace

void test_rigid_motion(mpm::testing::Report& report) {
  const double quarter = 0.5 * std::numbers::pi;
  const Vector3 turned = rotation({0.0, 0.0, quarter}) * Vector3{1.0, 2.0, 3.0};
  CHECK(distance(turned, {-2.0, 1.0, 3.0}) < 1e-15);
  const Matrix3 R = rotation({0.3, -0.7, 0.2}), back = transposed(R);
  const Vector3 any{0.4, -1.1, 2.0};
  CHECK(distance(back * (R * any), any) < 1e-15);

  // Eight equal masses at the corners of a box of edges 2 a, 2 b, 2 c: I_xx = M (b^2 + c^2).
  const double half[3] = {1.0, 2.0, 0.5}, M = 4.0;
  const Vector3 v{0.3, -0.2, 0.1}, w{1.0, 2.0, -1.5};
  RigidSums sums;
  RigidTotal parts;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3 r;
    for (int a = 0; a < 3; ++a) r[a] = (corner >> a & 1 ? 1.0 : -1.0) * half[a];
    sums.add(M / 8.0, r, v + cross(w, r));
    RigidSums one;
    one.add(M / 8.0, r, v + cross(w, r));
    for (int a = 0; a < 3; ++a) one.extent.add(a, r[a]);
    parts.add(one);
  }
  CHECK_CLOSE(sums.mass, M, 1e-15);
  CHECK_CLOSE(sums.inertia[0][0], M * (4.0 + 0.25), 1e-14);
  CHECK_CLOSE(sums.inertia[0][1], 0.0, 1e-15);
  CHECK(distance((1.0 / M) * sums.momentum, v) < 1e-15);
  CHECK(distance(spin_of(sums.inertia, sums.angular, 7u), w) < 1e-14);
  const Vector3 held = spin_of(sums.inertia, sums.angular, 4u);
  CHECK(held[0] == 0.0 && held[1] == 0.0 && std::abs(held[2] - w[2]) < 1e-14);
  const RigidSums total = parts.value();
  CHECK_CLOSE(total.inertia[2][2], sums.inertia[2][2], 1e-14);
  CHECK(total.extent.lower[1] == -2.0 && total.extent.upper[1] == 2.0);

  // A row of particles oblique to the axes: it turns across its line, and not about it.
  for (const Vector3& line : {Vector3{1.0, 1.0, 0.0}, Vector3{1.0, -2.0, 3.0}, any}) {
    RigidSums row;
    for (const double at : {-1.0, -0.5, 0.5, 1.0}) row.add(2.0, at * line, cross(w, at * line));
    const Vector3 across = w - (dot(w, line) / dot(line, line)) * line;
    CHECK(distance(spin_of(row.inertia, row.angular, 7u), across) < 1e-13, line[0], line[1]);
  }

  // Turning freely: angular momentum stays, energy to second order in the step.
  double error[2];
  for (int k = 0; k < 2; ++k) {
    RigidMotion motion;
    motion.velocity = v;
    motion.spin = w;
    motion.inertia = sums.inertia;
    const Vector3 angular = motion.inertia * motion.spin;
    const double energy = dot(motion.spin, angular);
    const int steps = k == 0 ? 200 : 400;
    for (int n = 0; n < steps; ++n) turn(motion, 1.0 / steps);
    const double lost = distance(motion.inertia * motion.spin, angular);
    CHECK(lost < 1e-11, lost, norm(angular));  // the rounding of 400 steps
    CHECK(distance(motion.centre, v) < 1e-13);
    error[k] = std::abs(dot(motion.spin, angular) / energy - 1.0);
  }
  CHECK(error[0] < 1e-3 && error[1] < 0.3 * error[0] + 1e-15, error[0], error[1]);
}
