#pragma once
// The filter of XPIC in the reference step.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// u = (I - S S+)^k V (Hammerquist & Nairn 2017), of bodies that deform: k times what the nodes'
/// velocities, mapped from u, have at the particles is taken from it.
template <int D>
void filter_velocities(Step<D>& step, int k) {
  for (Body<D>& b : step.bodies)
    for (Particle<D>& p : b.particles) p.unseen = p.v;
  for (int j = 0; j < k; ++j) {
    Step<D> mapped = step;  // whose particles have the velocity u
    for (Body<D>& b : mapped.bodies)
      for (Particle<D>& p : b.particles) p.v = p.unseen;
    mapped.map_momentum();
    for (std::size_t b = 0; b < step.bodies.size(); ++b)
      for (Particle<D>& p : step.bodies[b].particles)
        step.for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          p.unseen -= N * mapped.bodies[b].nodes[i].v;
        });
  }
}

}  // namespace mpm::reference
