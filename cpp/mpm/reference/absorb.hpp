#pragma once
// Absorbing walls in the reference step: dashpots on the nodes of a face, which stand for what lies
// behind it (Lysmer & Kuhlemeyer 1969, eqs. 1-2 with a = b = 1).
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// f_i -= C_i (v_i + dt a_i / 2), C_i = sum rho c A_p N_i over the particles in the cells before
/// the face: c is the speed of pressure waves along the normal, of shear waves along the face; A_p
/// = m_p / (rho h); N_i are the hats on the face.
template <int D>
void absorb_at_walls(Step<D>& step) {
  for (Body<D>& b : step.bodies) {
    if (!b.deforms()) continue;
    const Elastic& law = b.material;
    const double rho = law.density, pressure = std::sqrt(rho * (law.lambda + 2.0 * law.G)),
                 shear = std::sqrt(rho * law.G);
    std::map<Index<D>, Vec<double, D>> C;
    for (const Particle<D>& p : b.particles)
      for (int normal = 0; normal < D; ++normal)
        for (int side = 0; side < 2; ++side) {
          const auto axis = static_cast<std::size_t>(normal);
          const std::int32_t face = side == 0 ? 0 : step.walls.cells[axis];
          const double x = p.x[normal] / step.h, depth = side == 0 ? x - face : face - x;
          if (step.walls.face[normal][side] != Wall::absorbing || depth < 0.0 || depth >= 1.0)
            continue;
          Index<D> low, high;
          for (std::size_t a = 0; a < D; ++a) {
            low[a] = a == axis ? face : static_cast<std::int32_t>(std::floor(p.x[int(a)] / step.h));
            high[a] = low[a] + (a == axis ? 0 : 1);
          }
          for_each_index<D>(low, high, [&](const Index<D>& i) {
            double share = p.m / (rho * step.h);
            for (int a = 0; a < D; ++a)
              if (a != normal) share *= linear(p.x[a] / step.h - i[static_cast<std::size_t>(a)]).N;
            auto& at = C.try_emplace(i, Vec<double, D>::zero()).first->second;
            for (int a = 0; a < D; ++a) at[a] += share * (a == normal ? pressure : shear);
          });
        }
    for (const auto& [i, factor] : C) {
      Node<D>& node = b.nodes[i];
      for (int a = 0; a < D; ++a) {
        // The acceleration is that with the dashpot: f - C (v + dt f / 2 m) solved for f.
        const double half = 0.5 * step.dt / node.m;
        node.f_absorb[a] = -factor[a] * (node.v[a] + half * node.f[a]) / (1.0 + half * factor[a]);
      }
      hold(step.walls, i, node.f_absorb);
      node.f += node.f_absorb;
    }
  }
}

}  // namespace mpm::reference
