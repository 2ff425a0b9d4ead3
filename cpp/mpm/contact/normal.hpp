#pragma once
// The normal of a pair of bodies at a node.
#include <algorithm>

#include "mpm/contact/separation.hpp"
#include "mpm/contact/settings.hpp"

namespace mpm {

/// Sum of m_p grad N_ip [kg/m] over the particles of a body around a node, counted from the tile's
/// first; it points out of the body. `edge` is the particles' edge at the start [cells].
template <int D>
Vec<double, D> mass_gradient(const TileParticles<D>& particles, const Index<D>& node,
                             const TileGrid<D>& grid, double edge) {
  using T = Batch<contact_lanes>;
  Vec<T, D> total = Vec<T, D>::zero();
  Bases::with(grid.basis, edge, [&]<BasisModel B>(const B& basis) {
    particles.around(node, [&](const Index<D>& place, const auto& lanes) {
      for (int a = 0; a < D; ++a) {
        T g = lanes.mass;
        for (int b = 0; b < D; ++b) {
          const auto w = basis.along(lanes.xi[b]);
          const int k = place[static_cast<std::size_t>(b)] + B::before;
          g = g * (b == a ? w.dN[k] : w.N[k]);
        }
        total[a] += g;
      }
    });
  });
  Vec<double, D> r;
  for (int a = 0; a < D; ++a) r[a] = sum(total[a]) / grid.cell_size;
  return r;
}

/// The outward unit normal of a body at a node, times min(1, |gradient| h / mass): one where the
/// body ends at the node, near zero where the body surrounds it and the direction of its gradient
/// is chance.
template <int D>
Vec<double, D> weighted_normal(const Vec<double, D>& gradient, double mass, double cell_size) {
  const double length = norm(gradient);
  return length > 0.0 ? (std::min(1.0, length * cell_size / mass) / length) * gradient
                      : Vec<double, D>::zero();
}

/// What a normal is made of, of one body at a node.
template <int D>
struct NormalSource {
  int body;
  double stiffness;  // rho c^2 of its material [Pa]
  NearParticles<D> particles;
  Vec<double, D> normal;  // from the gradient of mass (weighted_normal); zero for `plane`
};

/// The unit normal from body r to body s by the chosen rule; zero if there is none.
template <int D>
Vec<double, D> pair_normal(const NormalSource<D>& r, const NormalSource<D>& s, NormalRule rule,
                           unsigned held) {
  constexpr double parallel = 1e-6;  // normals that differ by less give no direction
  const bool r_is_first = r.body < s.body;
  const bool r_is_stiffer = r.stiffness != s.stiffness ? r.stiffness > s.stiffness : r_is_first;
  const auto of_one = [&](bool takes_r) {
    return normalised(takes_r ? r.normal : -1.0 * s.normal);
  };
  switch (rule) {
    case NormalRule::plane:
      return separating_normal(r.particles, s.particles, held);
    case NormalRule::pair:
      return normalised(r.normal - s.normal, parallel);
    case NormalRule::first:
      return of_one(r_is_first);
    case NormalRule::second:
      return of_one(!r_is_first);
    case NormalRule::stiffer:
      break;
  }
  return of_one(r_is_stiffer);
}

}  // namespace mpm
