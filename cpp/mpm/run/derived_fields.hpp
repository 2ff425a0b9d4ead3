#pragma once
// Fields of a frame that follow from what particles keep: a row each.
#include <cmath>
#include <limits>

#include "mpm/domain.hpp"

namespace mpm {

/// What a derived field may be made of: stress xx yy zz yz xz xy [Pa], zeros where 2D has none; the
/// way from the start [m], where that is kept; the volume at the start [m^3], or [m^2] in 2D; the
/// density [kg/m^3]; the number of dimensions; and what a speed of sound is found from.
struct ParticleState {
  double stress[6], displacement[3];
  double initial_volume, density;
  int dimension;
  const Material* material = nullptr;
  const Columns* columns = nullptr;
  const MaterialColumns* at = nullptr;
  std::uint32_t row = 0;

  /// Of the fastest waves [m/s], without what viscosities add for the time step.
  double sound_speed() const {
    constexpr double no_cell = std::numeric_limits<double>::infinity();
    return dimension == 2 ? mpm::sound_speed<2>(*material, *columns, *at, row, no_cell)
                          : mpm::sound_speed<3>(*material, *columns, *at, row, no_cell);
  }
};

template <int D>
ParticleState particle_state(const Domain<D>& domain, const Body<D>& body,
                             const ParticlePool<D>& pool, std::uint32_t row) {
  const double m = pool.mass()[row];
  ParticleState p{{},
                  {},
                  m / body.initial_density,
                  m / pool.volume()[row],
                  D,
                  &domain.materials[static_cast<std::size_t>(body.material)],
                  &pool.columns,
                  &pool.at,
                  row};
  for (int c = 0; c < Sym<double, D>::size; ++c)
    p.stress[D == 2 && c == 3 ? 5 : c] = pool.stress(c)[row];
  for (int c = 0; c < 3; ++c) p.stress[c] -= averaged_away(pool, row);
  if (pool.start_position >= 0)
    for (int a = 0; a < D; ++a)
      p.displacement[a] = pool.x(a)[row] - pool.columns.component(pool.start_position + a)[row];
  return p;
}

/// When a frame has a field: it stays as it is at the start, or a case asks for it.
enum class Kept { in_every_frame, once, on_request };

struct DerivedField {
  std::string_view name, unit, meaning;
  Kept kept;
  double (*value)(const ParticleState&, int component);
  int components = 1;
};

inline constexpr auto derived_fields = std::to_array<DerivedField>({
    {"pressure", "Pa", "mean compressive stress", Kept::in_every_frame,
     [](const ParticleState& p, int) { return -(p.stress[0] + p.stress[1] + p.stress[2]) / 3.0; }},
    {"von_mises", "Pa", "equivalent stress sqrt(3/2 s:s), s the deviator (von Mises 1913)",
     Kept::in_every_frame,
     [](const ParticleState& p, int) {
       const double* const s = p.stress;
       const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
       const double normal = a * a + b * b + c * c;
       const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
       return std::sqrt(0.5 * normal + 3.0 * shear);
     }},
    {"size", "m", "edge of the square or cube that the particle was at the start", Kept::once,
     [](const ParticleState& p, int) {
       return p.dimension == 2 ? std::sqrt(p.initial_volume) : std::cbrt(p.initial_volume);
     }},
    {"density", "kg/m^3", "mass over present volume", Kept::on_request,
     [](const ParticleState& p, int) { return p.density; }},
    {"sound_speed", "m/s", "of the fastest waves, by the material's models", Kept::on_request,
     [](const ParticleState& p, int) { return p.sound_speed(); }},
    {"displacement", "m", "from the place at the start", Kept::on_request,
     [](const ParticleState& p, int component) { return p.displacement[component]; }, 3},
});

}  // namespace mpm
