#pragma once
// Body forces in the reference step: m_p b(x_p, X_p, t) on each particle.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// f_i += sum m_p N_ip b(x_p, X_p, t + dt / 2); after load_surfaces, with whose forces they count.
template <int D>
void add_body_forces(Step<D>& step) {
  for (Body<D>& b : step.bodies) {
    if (!b.force) continue;
    for (auto& [i, node] : b.nodes) node.f_body = Vec<double, D>::zero();
    for (const Particle<D>& p : b.particles) {
      const Vec<double, D> f = p.m * b.force(p.x, p.X, step.t + 0.5 * step.dt);
      step.for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
        b.nodes[i].f_body += N * f;
      });
    }
    step.fold(b, [](Node<D>& node, Node<D>& image, auto&& mirrored) {
      image.f_body += mirrored(node.f_body);
    });
    for (auto& [i, node] : b.nodes) {
      hold(step.walls_of(b), i, node.f_body);
      node.f += node.f_body;
      node.f_load += node.f_body;
    }
  }
}

}  // namespace mpm::reference
