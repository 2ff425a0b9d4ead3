#pragma once
// Contact of two bodies in the reference step, as the paper has it: normals from the gradients of
// mass, and what acts where the bodies approach each other.
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// n_r ~ sum m_p grad N_ip points out of r, and n = n_r - n_s from r to s, eq. (4). A body's own
/// counts less where the body surrounds the node and the gradient's direction is chance.
template <int D>
void Step<D>::find_contacts() {
  contacts.clear();
  std::map<Index<D>, Vec<double, D>> normal[2];
  for (std::size_t k = 0; k < 2; ++k) {
    for (const Particle<D>& p : bodies[k].particles)
      for_each_node(p.x, [&](const Index<D>& i, double, const Vec<double, D>& dN) {
        const auto at = normal[k].try_emplace(i, Vec<double, D>::zero()).first;
        at->second += p.m * dN;
      });
    for (auto& [i, n] : normal[k]) {
      hold(i, n);
      n = std::min(1.0, norm(n) * h / bodies[k].nodes[i].m) * normalised(n);
    }
  }
  for (auto& [i, r] : bodies[0].nodes) {
    const auto s = bodies[1].nodes.find(i);
    if (s == bodies[1].nodes.end() || walls.image(i)) continue;
    contacts.push_back({i, &r, &s->second, normalised(normal[0][i] - normal[1][i], 1e-6)});
  }
}

/// p_r' = p_r - a n, p_s' = p_s + a n with a = (m_s p_r - m_r p_s) . n / (m_r + m_s) > 0.
template <int D>
void Step<D>::contact_momentum(Vec<double, D> Node<D>::* velocity) {
  for (Contact<D>& c : contacts) {
    const double approach = dot(c.r->*velocity - c.s->*velocity, c.n);
    c.touching = approach >= 0.0;
    const double a = c.r->m * c.s->m / (c.r->m + c.s->m) * std::max(approach, 0.0);
    c.r->*velocity -= (a / c.r->m) * c.n;
    c.s->*velocity += (a / c.s->m) * c.n;
  }
  for (Body<D>& b : bodies) reflect(b, velocity);
}

/// f_nor = (m_s P_r - m_r P_s) . n / ((m_r + m_s) dt) > 0 with P = m v + dt f, f_tan likewise along
/// the slip, and of that no more than mu f_nor.
template <int D>
void Step<D>::contact_forces() {
  for (Contact<D>& c : contacts) {
    if (!c.touching) continue;
    const Vec<double, D> P_r = c.r->m * c.r->v + dt * c.r->f, P_s = c.s->m * c.s->v + dt * c.s->f;
    const Vec<double, D> all = (1.0 / ((c.r->m + c.s->m) * dt)) * (c.s->m * P_r - c.r->m * P_s);
    const double f_nor = std::max(dot(all, c.n), 0.0);
    const Vec<double, D> tangential = all - dot(all, c.n) * c.n;
    const double f_fric = std::min(mu * f_nor, norm(tangential));
    c.f = f_nor * c.n + f_fric * normalised(tangential);
    c.r->f -= c.f;
    c.s->f += c.f;
  }
}

}  // namespace mpm::reference
