#pragma once
// What acts on a body at a node of contact: what it is given before contact, and what it has got.
#include "mpm/contact/contact.hpp"
#include "mpm/loads/damping.hpp"

namespace mpm {

/// What a step does to the nodes beside the forces that they have been given.
template <int D>
struct ContactStep {
  const std::vector<Body<D>>& bodies;
  const std::vector<Damping>& dampings;  // of their motion
  Vec<double, D> gravity;                // [m/s^2]
  double time_step;                      // [s]

  StepDamping damping_of(const BodyAtNode<D>& side) const {
    if (dampings.empty()) return {};
    return damping_in(dampings, bodies[static_cast<std::size_t>(side.body)].damping);
  }
};

/// Gravity along the axes that no wall holds at a node.
template <int D>
Vec<double, D> free_gravity(const ContactNode& node, Vec<double, D> gravity) {
  for (int a = 0; a < D; ++a)
    if (node.constrained_axes >> a & 1u) gravity[a] = 0.0;
  return gravity;
}

/// Impulse over the step of all but the others on a body at a node: its forces, gravity, and the
/// drag on the velocity at the start. What damps locally follows from all forces, the others' too
/// (decision 0050).
// Gravity cancels from eqs. (13) and (15) between two free bodies, m_s m_r g - m_r m_s g = 0, but
// not against a wall or a prescribed body, where it is what presses. The nodes get it later, so it
// is added here.
template <int D>
Vec<double, D> impulse_alone(TileGrid<D>& grid, const ContactStep<D>& step, const ContactNode& node,
                             const BodyAtNode<D>& side) {
  Vec<double, D> f = read(grid, side, force_at) + side.mass * step.gravity;
  for (int a = 0; a < D; ++a)
    if (node.constrained_axes >> a & 1u) f[a] = 0.0;
  Vec<double, D> impulse = step.time_step * f;
  const double drag = step.damping_of(side).half_drag(step.time_step);
  if (drag > 0.0) impulse -= (2.0 * drag * side.mass) * read(grid, side, velocity_at);
  return impulse;
}

/// What has pushed a body at a node, once it is solved.
template <int D>
struct PushedNode {
  Vec<double, D> impulse;  // of the others [N s]
  Vec<double, D> own;      // of all forces on the mass that is the node's own [N s]
};
template <int D>
PushedNode<D> pushed_node(TileGrid<D>& grid, const ContactStep<D>& step, const ContactNode& node,
                          const BodyAtNode<D>& side, const SolvedSide<D>& solved) {
  const double dt = step.time_step;
  const Vec<double, D> velocity = read(grid, side, velocity_at);
  const Vec<double, D> change = solved.momentum - solved.mass * velocity;  // of all forces
  const Vec<double, D> alone = impulse_alone(grid, step, node, side);
  // What is left are the others' impulses alone: they become the force of eqs. (11)-(12), which all
  // copies of the node's record get, for no sum over patches follows.
  PushedNode<D> pushed{change - alone, change};
  const StepDamping damping = step.damping_of(side);
  if (!damping.acts()) {
    // The node itself has its own mass only.
    const double own_mass = grid.nodes.record_at(side.place)[mass_at];
    pushed.own -= (dt * (side.mass - own_mass)) * free_gravity(node, step.gravity);
    return pushed;
  }
  // As the node will be advanced: by local damping too.
  const Vec<double, D> forces =
      (1.0 / dt) * (pushed.impulse + alone) + (damping.rate * side.mass) * velocity;
  for (int a = 0; a < D; ++a)
    pushed.own[a] =
        side.mass * advance_damped(damping, side.mass, velocity[a], forces[a], dt).increment;
  return pushed;
}

}  // namespace mpm
