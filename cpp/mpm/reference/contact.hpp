#pragma once
// Contact of two bodies in the reference step, as the paper has it: normals from the gradients of
// mass, and what acts where the bodies approach each other.
#include "mpm/reference/prescribed.hpp"
#include "mpm/reference/springs.hpp"
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// The masses with which bodies that do not deform meet others: of one that moves as prescribed
/// infinite, but where it has a share below 1 of a tenth of the other's volume, share / (1 - share)
/// of its mass: a node that it has only just reached is not held. A rigid body has the mass of all
/// of it, shared out among the nodes at which it meets the other.
template <int D>
void find_meeting_masses(Step<D>& step) {
  double shared[2] = {0.0, 0.0};
  for (const Contact<D>& c : step.contacts) shared[0] += c.r->m, shared[1] += c.s->m;
  const auto inverse = [&](std::size_t k, double own, double other) {
    const Body<D>&b = step.bodies[k], &met = step.bodies[1 - k];
    if (b.deforms()) return 1.0 / own;
    if (b.prescribed()) {
      const double share = own / b.material.density / (0.1 * other / met.material.density);
      return share < 1.0 ? (1.0 - share) / (share * other) : 0.0;
    }
    double all = 0.0;
    for (const Particle<D>& p : b.particles) all += p.m;
    return shared[k] / (own * all);
  };
  for (Contact<D>& c : step.contacts) {
    c.w_r = inverse(0, c.r->m, c.s->m);
    c.w_s = inverse(1, c.s->m, c.r->m);
  }
}

/// n_r ~ sum m_p grad N_ip points out of r, and n = n_r - n_s from r to s, eq. (4). A body's own
/// counts less where the body surrounds the node and the gradient's direction is chance.
template <int D>
void find_contacts(Step<D>& step) {
  step.contacts.clear();
  std::map<Index<D>, Vec<double, D>> normal[2];
  for (std::size_t k = 0; k < 2; ++k) {
    for (const Particle<D>& p : step.bodies[k].particles)
      step.for_each_node(p.x, [&](const Index<D>& i, double, const Vec<double, D>& dN) {
        const auto at = normal[k].try_emplace(i, Vec<double, D>::zero()).first;
        at->second += p.m * dN;
      });
    for (auto& [i, n] : normal[k]) {
      hold(step.walls, i, n);
      n = std::min(1.0, norm(n) * step.h / step.bodies[k].nodes[i].m) * normalised(n);
    }
  }
  for (auto& [i, r] : step.bodies[0].nodes) {
    const auto s = step.bodies[1].nodes.find(i);
    if (s == step.bodies[1].nodes.end() || step.walls.image(i)) continue;
    step.contacts.push_back({i, &r, &s->second, normalised(normal[0][i] - normal[1][i], 1e-6),
                             1.0 / r.m, 1.0 / s->second.m});
  }
  find_meeting_masses(step);
  if (step.springs) find_springs(step);
}

/// p_r' = p_r - a n, p_s' = p_s + a n with a = (m_s p_r - m_r p_s) . n / (m_r + m_s) > 0.
template <int D>
void contact_momentum(Step<D>& step, Vec<double, D> Node<D>::* velocity) {
  const bool mapped = velocity == &Node<D>::v;  // else remapped, which particles take no part in
  for (Body<D>& b : step.bodies)
    for (auto& [i, node] : b.nodes)
      if (mapped) node.v_corrected = node.v;
  for (Contact<D>& c : step.contacts) {
    if (step.springs) continue;  // they push with forces alone
    const double approach = dot(c.r->*velocity - c.s->*velocity, c.n);
    c.touching = approach >= 0.0;
    const double a = std::max(approach, 0.0) / (c.w_r + c.w_s);
    c.r->*velocity -= (a * c.w_r) * c.n;
    c.s->*velocity += (a * c.w_s) * c.n;
  }
  for (Body<D>& b : step.bodies) {
    step.reflect(b, velocity);
    if (b.prescribed()) set_prescribed_velocities(step, b, velocity);  // whatever pushes it
    for (auto& [i, node] : b.nodes)
      if (mapped) node.v_corrected = node.v - node.v_corrected;
  }
}

/// f_nor = (m_s P_r - m_r P_s) . n / ((m_r + m_s) dt) > 0 with P = m v + dt f, f_tan likewise along
/// the slip, and of that no more than mu f_nor. Drag by the velocity in the middle of the step
/// makes P - dt alpha m v of P and m (1 + dt alpha / 2) of m.
template <int D>
void contact_forces(Step<D>& step) {
  const auto half_drag = [&](std::size_t k) { return 0.5 * step.dt * step.bodies[k].alpha; };
  /// P / m: where a body would go without the other.
  const auto alone = [&](std::size_t k, const Node<D>& i) {
    if (step.bodies[k].prescribed()) return i.v + i.dv;
    const double drag = half_drag(k);
    return (1.0 / (1.0 + drag)) * ((1.0 - drag) * i.v + (step.dt / i.m) * i.f);
  };
  for (Contact<D>& c : step.contacts) {
    if (!c.touching) continue;
    const double w = c.w_r / (1.0 + half_drag(0)) + c.w_s / (1.0 + half_drag(1));
    const Vec<double, D> slip = alone(0, *c.r) - alone(1, *c.s);
    const Vec<double, D> all = (1.0 / (w * step.dt)) * slip;
    // With the approach at the end of the step: F + k u dt / 4 (share_of_approach).
    const double per_speed = 0.25 * step.dt * c.stiffness;
    const double f_nor =
        step.springs
            ? std::max((c.push + per_speed * dot(slip, c.n)) / (1 + per_speed * w * step.dt), 0.0)
            : std::max(dot(all, c.n), 0.0);
    const Vec<double, D> tangential = all - dot(all, c.n) * c.n;
    const double f_fric = std::min(step.mu * f_nor, norm(tangential));
    c.f = f_nor * c.n + f_fric * normalised(tangential);
    c.r->f -= c.f;
    c.s->f += c.f;
  }
}

}  // namespace mpm::reference
