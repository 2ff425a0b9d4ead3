#pragma once
// Springs between the particles of two bodies that overlap (decision 0051): the reference.
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

/// At each node: of every particle p of either body the deepest overlap with a particle q of the
/// other, under q's cap, is the shortening of a block of an edge of both, on p's face; half of it,
/// as the others have their turn.
template <int D>
void find_springs(Step<D>& step) {
  constexpr double cap = 8.0;  // edges
  const double reach = 1.0 + step.half_width;
  for (Contact<D>& c : step.contacts) {
    const auto near = [&](const Particle<D>& p) {
      bool all = dot(c.n, c.n) > 0.0;
      for (std::size_t a = 0; a < D; ++a)
        all = all && std::abs(p.x[static_cast<int>(a)] / step.h - c.node[a]) < reach;
      return all;
    };
    for (const std::size_t k : {0, 1}) {
      const Body<D>&own = step.bodies[k], &other = step.bodies[1 - k];
      const Vec<double, D> n = (k == 0 ? 1.0 : -1.0) * c.n;
      const auto give = [](const Body<D>& b) {  // 1 / (rho c^2)
        const double speed = b.material.sound_speed(1.0);
        return b.deforms() ? 1.0 / (b.material.density * speed * speed) : 0.0;
      };
      for (const Particle<D>& p : own.particles) {
        if (!near(p)) continue;
        const double l = 0.5 * step.edge(p.V);
        double overlap = 0.0, l_q = 0.0;
        for (const Particle<D>& q : other.particles) {
          if (!near(q)) continue;
          const Vec<double, D> d = q.x - p.x;
          const double half = 0.5 * step.edge(q.V), along = dot(d, n);
          const double here =
              l + half - along - (dot(d, d) - along * along) / (2.0 * cap * 2.0 * half);
          if (here > overlap) overlap = here, l_q = half;
        }
        if (!(overlap > 0.0)) continue;
        const double face = std::pow(2.0 * l, D - 1);
        const double N = share_of_node<D>(step, c.node, p.x + (l - 0.5 * overlap) * n);
        const double k_p = 0.5 * N * face / (2.0 * (l * give(own) + l_q * give(other)));
        c.stiffness += k_p;
        c.push += k_p * overlap;
      }
    }
    c.touching = c.push > 0.0;
  }
}

}  // namespace mpm::reference
