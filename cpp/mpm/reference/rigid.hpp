#pragma once
// Rigid bodies in the reference step: their particles have no stress and move as one, by the laws
// of Newton and Euler.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// The rigid motion of the same momentum and angular momentum as the particles of a body.
template <int D>
RigidMotion motion_of(const std::vector<Particle<D>>& particles) {
  RigidMotion motion;
  double mass = 0.0;
  for (const Particle<D>& p : particles) {
    mass += p.m;
    motion.centre += p.m * in_space<D>(p.x);
    motion.velocity += p.m * in_space<D>(p.v);
  }
  motion.centre = (1.0 / mass) * motion.centre;
  motion.velocity = (1.0 / mass) * motion.velocity;
  motion.free_axes = D == 2 ? 4u : 7u;
  RigidSums about_centre;
  for (const Particle<D>& p : particles)
    about_centre.add(p.m, in_space<D>(p.x) - motion.centre, in_space<D>(p.v));
  motion.inertia = about_centre.inertia;
  motion.spin = spin_of(motion.inertia, about_centre.angular, motion.free_axes);
  return motion;
}

/// After eq. (17): v_p = v + w x (x_p - x).
template <int D>
void project_rigid_velocities(Step<D>& step) {
  for (Body<D>& b : step.bodies) {
    if (b.kind != BodyKind::rigid) continue;
    b.motion = motion_of(b.particles);
    for (Particle<D>& p : b.particles) p.v = from_space<D>(b.motion.velocity_at(in_space<D>(p.x)));
  }
}

/// In place of eq. (16): the particles turn about the centre, which moves straight.
template <int D>
void move_rigid_bodies(Step<D>& step) {
  for (Body<D>& b : step.bodies) {
    if (b.kind != BodyKind::rigid) continue;
    const Vector3 before = b.motion.centre;
    const Matrix3 turned = turn(b.motion, step.dt);
    for (Particle<D>& p : b.particles) {
      p.x = from_space<D>(b.motion.centre + turned * (in_space<D>(p.x) - before));
      p.v = from_space<D>(b.motion.velocity_at(in_space<D>(p.x)));
    }
  }
}

}  // namespace mpm::reference
