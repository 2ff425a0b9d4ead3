#pragma once
// Springs between particles and the body that they overlap (decisions 0051 and 0054): the reference.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// N_i(x), and for a node before a wall that mirrors what the node behind it has.
template <int D>
double share_of_node(const Step<D>& step, const Index<D>& i, const Vec<double, D>& x) {
  double share = 1.0;
  for (int a = 0; a < D; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const auto N = [&](int node) { return step.S(x[a] / step.h - node).N; };
    double of_axis = N(i[k]);
    for (const std::size_t side : {0, 1}) {
      const Wall wall = step.walls.face[k][side];
      const int image = side == 0 ? -i[k] : 2 * step.walls.cells[k] - i[k];
      if (side == 0 ? image >= 0 : image <= step.walls.cells[k]) continue;
      if (wall == Wall::slip) of_axis += N(image);
      if (wall == Wall::fixed && step.walls.odd_at_fixed) of_axis -= N(image);
    }
    share *= of_axis;
  }
  return share;
}

/// The sum over the particles of a body of (1 - d^2 / 4 e^2)^6 up to two of their edges e, at most
/// `range`, and half their edge in that mean. Beyond the walls of the box the body goes on.
struct Surface {
  double sum = 0.0, halves = 0.0;
};
template <int D>
Surface surface_at(const Step<D>& step, const Body<D>& body, const Vec<double, D>& x,
                   double range) {
  Surface surface;
  const auto add = [&](const Vec<double, D>& image) {
    for (const Particle<D>& q : body.particles) {
      const double half = 0.5 * step.edge(q.V), end = std::min(4.0 * half, range);
      const double t = 1.0 - dot(q.x - image, q.x - image) / (end * end);
      if (!(t > 0.0)) continue;
      surface.sum += std::pow(t, 6);
      surface.halves += std::pow(t, 6) * half;
    }
  };
  // Each axis: the point itself, and what it is beyond either wall.
  Index<D> low, high;
  low.fill(-1), high.fill(1);
  for_each_index<D>(low, high, [&](const Index<D>& side) {
    Vec<double, D> image = x;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (side[k] == 0) continue;
      if (step.walls.face[k][side[k] < 0 ? 0 : 1] == Wall::free) return;
      image[a] = (side[k] < 0 ? 0.0 : 2.0 * step.walls.cells[k] * step.h) - x[a];
    }
    add(image);
  });
  return surface;
}

/// At each node, of every particle p of either body that the surface of the other lies over: the
/// overlap is the shortening of a block of an edge of both, on p's face; half of it, as the others
/// have their turn. A flat layer has the sum S_1 (4/3 (1 - z^2 / 4 e^2))^m at the height z.
template <int D>
void find_springs(Step<D>& step) {
  const double m = 6.0 + 0.5 * (D - 1);
  const double S_1 = D == 2 ? 243.0 * std::sqrt(3.0) / 2002.0 : std::acos(-1.0) * 2187.0 / 28672.0;
  for (const std::size_t k : {0, 1}) {
    const Body<D>&own = step.bodies[k], &other = step.bodies[1 - k];
    const auto give = [](const Body<D>& b) {  // 1 / (rho c^2)
      const double speed = b.material.sound_speed(1.0);
      return b.deforms() ? 1.0 / (b.material.density * speed * speed) : 0.0;
    };
    for (const Particle<D>& p : own.particles) {
      const Surface surface = surface_at(step, other, p.x, step.surface_range * step.h);
      if (!(surface.sum > 0.0)) continue;
      const double l = 0.5 * step.edge(p.V), l_q = surface.halves / surface.sum;
      const double root = 1.0 - 0.75 * std::pow(surface.sum / S_1, 1.0 / m);
      const double overlap = l + l_q - 4.0 * l_q * std::sqrt(std::max(root, 0.0));
      if (!(overlap > 0.0)) continue;
      const double face = std::pow(2.0 * l, D - 1);
      for (Contact<D>& c : step.contacts) {
        if (!(dot(c.n, c.n) > 0.0)) continue;
        const Vec<double, D> n = (k == 0 ? 1.0 : -1.0) * c.n;
        const double N = share_of_node<D>(step, c.node, p.x + (l - 0.5 * overlap) * n);
        const double k_p = 0.5 * N * face / (2.0 * (l * give(own) + l_q * give(other)));
        c.stiffness += k_p;
        c.push += k_p * overlap;
      }
    }
  }
  for (Contact<D>& c : step.contacts) c.touching = c.push > 0.0;
}

}  // namespace mpm::reference
