#pragma once
// Fields of a frame that follow from what particles keep: a row each.
#include <cmath>

#include "mpm/domain.hpp"

namespace mpm {

/// What a derived field may be made of: stress xx yy zz yz xz xy [Pa], zeros where 2D has none; the
/// volume at the start [m^3], or [m^2] in 2D; and the number of dimensions.
struct ParticleState {
  double stress[6];
  double initial_volume;
  int dimension;
};

template <int D>
ParticleState particle_state(const Body<D>& body, const ParticlePool<D>& pool, std::uint32_t row) {
  ParticleState p{{}, pool.mass()[row] / body.initial_density, D};
  for (int c = 0; c < Sym<double, D>::size; ++c)
    p.stress[D == 2 && c == 3 ? 5 : c] = pool.stress(c)[row];
  return p;
}

struct DerivedField {
  std::string_view name, unit, meaning;
  bool constant;  // it stays as it is at the start
  double (*value)(const ParticleState&);
};

inline constexpr auto derived_fields = std::to_array<DerivedField>({
    {"pressure", "Pa", "mean compressive stress", false,
     [](const ParticleState& p) { return -(p.stress[0] + p.stress[1] + p.stress[2]) / 3.0; }},
    {"von_mises", "Pa", "equivalent stress sqrt(3/2 s:s), s the deviator (von Mises 1913)", false,
     [](const ParticleState& p) {
       const double* const s = p.stress;
       const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
       const double normal = a * a + b * b + c * c;
       const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
       return std::sqrt(0.5 * normal + 3.0 * shear);
     }},
    {"size", "m", "edge of the square or cube that the particle was at the start", true,
     [](const ParticleState& p) {
       return p.dimension == 2 ? std::sqrt(p.initial_volume) : std::cbrt(p.initial_volume);
     }},
});

}  // namespace mpm
