#pragma once
// Bodies whose motion is prescribed in the reference step: their nodes and particles have the
// velocity of that motion, whatever acts on them.
#include "mpm/reference/rigid.hpp"

namespace mpm::reference {

/// The velocity of the centre and the spin of a step are their means over it.
template <int D>
void begin_prescribed_motions(Step<D>& step) {
  for (Body<D>& b : step.bodies) {
    if (!b.prescribed()) continue;
    b.last_motion = b.motion;
    for (std::size_t a = 0; a < 3; ++a) {
      b.motion.velocity.c[a] = b.velocity[a].mean(step.t, step.t + step.dt);
      b.motion.spin.c[a] = b.spin[a].mean(step.t, step.t + step.dt);
    }
  }
}

/// v_i = v + w x (x_i - x): of the last step until the nodes are advanced, of this one for the
/// remapped velocity; dv_i leads from one to the other.
template <int D>
void set_prescribed_velocities(const Step<D>& step, Body<D>& b,
                               Vec<double, D> Node<D>::* velocity) {
  const RigidMotion& motion = velocity == &Node<D>::v ? b.last_motion : b.motion;
  for (auto& [i, node] : b.nodes) {
    Vector3 x = Vector3::zero();
    for (int a = 0; a < D; ++a) x[a] = step.h * i[static_cast<std::size_t>(a)];
    node.*velocity = from_space<D>(motion.velocity_at(x));
    node.dv = from_space<D>(b.motion.velocity_at(x) - b.last_motion.velocity_at(x));
  }
}

/// In place of eqs. (16)-(17): x_p = x' + R (x_p - x), v_p = v + w x (x_p - x'), x' = x + dt v.
template <int D>
void move_prescribed_bodies(Step<D>& step) {
  for (Body<D>& b : step.bodies) {
    if (!b.prescribed()) continue;
    const Matrix3 R = rotation(step.dt * b.motion.spin);
    const Vector3 before = b.motion.centre;
    b.motion.centre += step.dt * b.motion.velocity;
    for (Particle<D>& p : b.particles) {
      p.x = from_space<D>(b.motion.centre + R * (in_space<D>(p.x) - before));
      p.v = from_space<D>(b.motion.velocity_at(in_space<D>(p.x)));
    }
  }
}

}  // namespace mpm::reference
