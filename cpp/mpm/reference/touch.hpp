#pragma once
// Walls that push back what touches them, in the reference step (decision 0060).
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// Springs k_p = rho c^2 A_p / e_p of particles that overlap a face by o_p = e_p / 2 - z_p, at the
/// middle of the overlap, come to F_i and K_i at the nodes: the force over a step
/// with the approach u at its end is F_i + K_i u dt / 4, if that pushes, and friction is up to mu
/// of it. The nodes are those that the particle reaches; the rest of a share is the face's. Without
/// springs the approach is stopped at those of them that lie on the face or beyond it.
template <int D>
void touch_walls(Step<D>& step) {
  struct Spring {
    double F = 0.0, K = 0.0, mu = 0.0;
  };
  for (Body<D>& b : step.bodies) {
    for (auto& [i, node] : b.nodes) node.f_touch = Vec<double, D>::zero();
    if (!b.deforms()) continue;
    const Elastic& law = b.material;
    const double modulus = law.lambda + 2.0 * law.G;
    std::map<Index<D>, std::array<Spring, D>> springs;
    for (const Particle<D>& p : b.particles)
      for (std::size_t n = 0; n < D; ++n)
        for (const int side : {0, 1}) {
          const int axis = static_cast<int>(n), inward = side == 0 ? 1 : -1;
          if (step.walls.face[n][side] != Wall::contact) continue;
          const std::int32_t face = side == 0 ? 0 : step.walls.cells[n];
          const double e = step.edge(p.V), o = 0.5 * e - inward * (p.x[axis] - step.h * face);
          if (!(o > 0.0)) continue;
          const double k = modulus * std::pow(e, D - 2);
          const auto add = [&](const Index<D>& i, double share) {
            const auto image = step.walls.image(i);  // what it was given is its image's
            const double sign = image ? image->component(1.0, axis) : 1.0;
            Spring& s = springs[image ? image->node : i][n];
            s.F += sign * share * k * o * inward;
            s.K += sign * share * k;
            s.mu = step.walls.friction[n][side];
          };
          // By lines of nodes along the normal, each with what the particle gives along the face.
          step.for_each_node(p.x, [&](const Index<D>& i, double, const Vec<double, D>&) {
            double beside = 1.0;
            for (std::size_t a = 0; a < D; ++a)
              if (a != n) beside *= step.S(p.x[static_cast<int>(a)] / step.h - i[a]).N;
            const double place = face - 0.5 * inward * o / step.h;
            const double share = beside * step.S(place - i[n]).N;
            add(i, share);
            // What the nodes lack that the particle does not reach, once a line.
            if (i[n] != face) return;
            double rest = beside;
            for (std::int32_t j = face - 3; j <= face + 3; ++j)
              if (step.S(p.x[axis] / step.h - j).N > 0.0) rest -= beside * step.S(place - j).N;
            add(i, rest);
          });
        }
    const double drag = 0.5 * step.dt * b.alpha;
    for (const auto& [i, all] : springs) {
      Node<D>& node = b.nodes[i];
      // Faces at right angles push each other only by friction: a few sweeps settle both.
      Vec<double, D> push = Vec<double, D>::zero(), rub[D];
      for (auto& r : rub) r = Vec<double, D>::zero();
      for (int sweep = 0; sweep < 500; ++sweep)
        for (int n = 0; n < D; ++n) {
          const Spring& s = all[static_cast<std::size_t>(n)];
          if (s.K == 0.0) continue;
          const double sign = s.F > 0.0 ? 1.0 : -1.0, m = (1.0 + drag) * node.m;
          Vec<double, D> others = push, free;
          for (int k = 0; k < D; ++k)
            if (k != n) others += rub[k];
          others[n] -= push[n];
          for (int a = 0; a < D; ++a)
            free[a] = ((1.0 - drag) * node.m * node.v[a] + step.dt * (node.f[a] + others[a])) / m;
          hold(step.walls, i, free);
          const double share = 0.25 * step.dt * s.K;  // of the approach, springs' share_of_approach
          const bool inside = sign > 0.0 ? i[static_cast<std::size_t>(n)] > 0
                                         : i[static_cast<std::size_t>(n)] <
                                               step.walls.cells[static_cast<std::size_t>(n)];
          if (!step.springs && inside) continue;
          const double force =
              step.springs
                  ? std::max((sign * s.F - share * sign * free[n]) / (1.0 + share * step.dt / m),
                             0.0)
                  : std::max(-sign * free[n] * m / step.dt, 0.0);
          push[n] = sign * force;
          free[n] = 0.0;
          const double size = norm(free), stop = size * m / step.dt;
          rub[n] =
              size > 0.0 ? (-std::min(s.mu * force, stop) / size) * free : Vec<double, D>::zero();
        }
      node.f_touch = push;
      for (const auto& r : rub) node.f_touch += r;
      node.f += node.f_touch;
    }
  }
}

}  // namespace mpm::reference
