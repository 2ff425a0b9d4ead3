#pragma once
// Springs between particles and the body that they overlap (decisions 0051 and 0054): the
// reference.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// add(share, signs): N_i(x), and for a node before a wall that mirrors what the nodes behind it
/// have, with the signs of a vector's components there.
template <int D, class F>
void share_of_node(const Step<D>& step, const Index<D>& i, const Vec<double, D>& x, F&& add) {
  Index<D> low, high;
  low.fill(-1), high.fill(1);
  for_each_index<D>(low, high, [&](const Index<D>& side) {
    double share = 1.0;
    Vec<double, D> signs;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      int node = i[k];
      signs[a] = 1.0;
      if (side[k] != 0) {
        node = (side[k] < 0 ? 0 : 2 * step.walls.cells[k]) - i[k];
        const bool beyond = side[k] < 0 ? node < 0 : node > step.walls.cells[k];
        const Wall wall = step.walls.face[k][side[k] < 0 ? 0 : 1];
        const bool odd = wall == Wall::fixed && step.walls.odd_at_fixed;
        if (!beyond || !(odd || wall == Wall::slip)) return;
        if (odd) share = -share;
        if (wall == Wall::slip) signs[a] = -1.0;
      }
      share *= step.S(x[a] / step.h - node).N;
    }
    if (share != 0.0) add(share, signs);
  });
}

/// The weight (1 - d^2 / R^2 e^2)^n by which particles of an edge e make a surface, R^2 = 1 + a^2,
/// and the sum of a flat layer at the height of an edge. 2 pi a is the first zero of the Bessel
/// function J_m, m = n + (D - 1) / 2.
template <int D>
struct Weight {
  double pi = std::acos(-1.0);
  int n = D == 2 ? 6 : 5;
  double m = n + 0.5 * (D - 1);
  double a = (D == 2 ? 10.512835408093999 : 9.936109524217791) / (2.0 * pi), R2 = 1.0 + a * a;
  double disc = D == 2 ? std::sqrt(pi) * std::tgamma(n + 1.0) / std::tgamma(n + 1.5) : pi / (n + 1);
  double S_1 = std::pow(a * a / R2, n) * std::pow(a, D - 1) * disc;
};

/// The sum of these weights over the particles of a body; half their edge in that mean; and the
/// gradient of the sum. Beyond the walls of the box the body goes on.
template <int D>
struct Surface {
  double sum = 0.0, halves = 0.0;
  Vec<double, D> gradient = Vec<double, D>::zero();
};
template <int D>
Surface<D> surface_at(const Step<D>& step, const Body<D>& body, const Vec<double, D>& x) {
  Surface<D> surface;
  // Each axis: the particles as they are, and what they are beyond either wall.
  Index<D> low, high;
  low.fill(-1), high.fill(1);
  for_each_index<D>(low, high, [&](const Index<D>& side) {
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (side[k] != 0 && !Walls<D>::goes_on(step.walls.face[k][side[k] < 0 ? 0 : 1])) return;
    }
    for (const Particle<D>& q : body.particles) {
      Vec<double, D> d = q.x - x;
      for (int a = 0; a < D; ++a) {
        const auto k = static_cast<std::size_t>(a);
        const double wall = side[k] < 0 ? 0.0 : step.walls.cells[k] * step.h;
        if (side[k] != 0) d[a] = 2.0 * wall - q.x[a] - x[a];
      }
      const Weight<D> weight;
      const double half = 0.5 * step.edge(q.V), end = 2.0 * half * std::sqrt(weight.R2);
      const double t = 1.0 - dot(d, d) / (end * end);
      if (!(t > 0.0)) continue;
      surface.sum += std::pow(t, weight.n);
      surface.halves += std::pow(t, weight.n) * half;
      surface.gradient += (2.0 * weight.n / (end * end) * std::pow(t, weight.n - 1)) * d;
    }
  });
  return surface;
}

/// At each node, of every particle p of either body that the surface of the other lies over: the
/// overlap is the shortening of a block of an edge of both, on p's face; half of it, as the others
/// have their turn. A flat layer has the sum S_1 ((R^2 - z^2 / e^2) / a^2)^m at the height z. The
/// normal of the node is that of the sum of the forces.
template <int D>
void find_springs(Step<D>& step) {
  const Weight<D> weight;
  const auto give = [](const Body<D>& b) {  // 1 / (rho c^2)
    const double speed = b.material.sound_speed(1.0);
    return b.deforms() ? 1.0 / (b.material.density * speed * speed) : 0.0;
  };
  struct Spring {
    double stiffness, overlap;
    Vec<double, D> n;  // from r to s
  };
  std::vector<std::vector<Spring>> springs(step.contacts.size());
  for (const std::size_t k : {0, 1}) {
    const Body<D>&own = step.bodies[k], &other = step.bodies[1 - k];
    for (const Particle<D>& p : own.particles) {
      const Surface<D> surface = surface_at(step, other, p.x);
      if (!(surface.sum > 0.0)) continue;
      const double l = 0.5 * step.edge(p.V), l_q = surface.halves / surface.sum;
      const double square =
          weight.R2 - weight.a * weight.a * std::pow(surface.sum / weight.S_1, 1.0 / weight.m);
      const double overlap = l + l_q - 2.0 * l_q * std::sqrt(std::max(square, 0.0));
      if (!(overlap > 0.0)) continue;
      const double face = std::pow(2.0 * l, D - 1);
      const Vec<double, D> n = normalised(surface.gradient), x = p.x + (l - 0.5 * overlap) * n;
      for (std::size_t i = 0; i < springs.size(); ++i) {
        share_of_node<D>(
            step, step.contacts[i].node, x, [&](double N, const Vec<double, D>& signs) {
              const double k_p = 0.5 * N * face / (2.0 * (l * give(own) + l_q * give(other)));
              Spring& spring =
                  springs[i].emplace_back(Spring{k_p, overlap, (k == 0 ? 1.0 : -1.0) * n});
              for (int a = 0; a < D; ++a) spring.n[a] *= signs[a];
            });
      }
    }
  }
  for (std::size_t i = 0; i < springs.size(); ++i) {
    Contact<D>& c = step.contacts[i];
    Vec<double, D> force = Vec<double, D>::zero();
    for (const Spring& spring : springs[i]) force += (spring.stiffness * spring.overlap) * spring.n;
    hold(step.walls, c.node, force);
    c.n = normalised(force);
    c.push = norm(force);
    for (const Spring& spring : springs[i])
      c.stiffness += spring.stiffness * dot(spring.n, c.n) * dot(spring.n, c.n);
    c.touching = c.push > 0.0;
  }
}

}  // namespace mpm::reference
