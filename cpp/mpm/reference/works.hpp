#pragma once
// The work of forces on the nodes in the reference step: each is constant over the step, in which
// the velocity goes from v - dv to v, so its work is dt f . (v - dv / 2).
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// Call between the advance of the nodes and that of the particles.
template <int D>
Works works(const Step<D>& step) {
  Works sum;
  for (const Body<D>& b : step.bodies) {
    const auto middle = [&](const Node<D>& i) { return i.v - 0.5 * i.dv; };
    for (const auto& [i, node] : b.nodes) {
      if (step.walls.image(i)) continue;  // what it was given is its image's
      sum.loads += step.dt * dot(node.f_load, middle(node));
      sum.absorbed -= step.dt * dot(node.f_absorb, middle(node));
      sum.touched -= step.dt * dot(node.f_touch, middle(node));
      sum.damped -= step.dt * dot(node.f_damp, middle(node));
      if (b.prescribed()) sum.on_prescribed += step.dt * dot(node.f, middle(node));
    }
    if (b.prescribed()) continue;
    for (const Particle<D>& p : b.particles)
      step.for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
        sum.gravity += step.dt * p.m * N * dot(step.g, middle(b.nodes.at(i)));
      });
  }
  return sum;
}

}  // namespace mpm::reference
