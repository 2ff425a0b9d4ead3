#include "mpm/particles/make_body.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace mpm {
namespace {

template <int D>
void check_particles(const std::string& name, std::span<const double> positions,
                     std::span<const double> velocities, std::span<const double> volumes) {
  const std::size_t n = positions.size() / D;
  if (n == 0 || n * D != positions.size())
    throw std::invalid_argument(name + ": positions must be (n, D) with n > 0");
  if (velocities.size() != D && velocities.size() != n * D)
    throw std::invalid_argument(name + ": velocities must be (n, D) or (1, D)");
  if (volumes.size() != 1 && volumes.size() != n)
    throw std::invalid_argument(name + ": volumes must be (n,) or (1,)");
  check_finite(positions, name + ": positions");
  check_finite(velocities, name + ": velocities");
  check_finite(volumes, name + ": volumes");
  for (const double v : volumes)
    if (!(v > 0.0)) throw std::invalid_argument(name + ": volumes must be > 0");
}

template <int D>
void add_columns(Body<D>& body, const Material& material, bool may_leave) {
  Columns& c = body.columns;
  body.position = c.add("position", "m", D);
  body.at.velocity = c.add("velocity", "m/s", D, Kept::rounded);
  body.at.mass = c.add("mass", "kg", 1);
  body.at.volume = c.add("volume", "m^3", 1);
  body.at.stress = c.add("stress", "Pa", Sym<double, D>::size, Kept::rounded);
  add_material_columns<D>(material, c, body.at);
  if (!may_leave) return;  // what particles that leave the region need
  if (body.at.recoverable < 0) body.at.recoverable = c.add("recoverable_energy", "J/m^3", 1);
  if (body.at.failed < 0) body.at.failed = c.add("failed", "1", 1);
}

}  // namespace

void check_finite(std::span<const double> values, const std::string& what) {
  for (const double v : values)
    if (!std::isfinite(v)) throw std::invalid_argument(what + " must be finite numbers");
}

template <int D>
Body<D> make_body(const std::string& name, const Material& material,
                  std::span<const double> positions, std::span<const double> velocities,
                  std::span<const double> volumes, const TileGrid<D>& grid) {
  check_particles<D>(name, positions, velocities, volumes);
  const std::size_t n = positions.size() / D;
  Body<D> body;
  body.name = name;
  add_columns(body, material, grid.keep.exist);
  body.columns.allocate(n);
  const bool one_velocity = velocities.size() == D, one_volume = volumes.size() == 1;
  double total = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < D; ++a) {
      body.x(static_cast<int>(a))[i] = positions[i * D + a];
      body.v(static_cast<int>(a))[i] =
          static_cast<Rounded>(velocities[one_velocity ? a : i * D + a]);
    }
    const double volume = volumes[one_volume ? 0 : i];
    total += volume;
    body.volume()[i] = volume;
    body.mass()[i] = material.density * volume;
  }
  start_material_columns<D>(material, body.columns, body.at);
  const double speed = sound_speed<D>(material, body.columns, body.at, 0, grid.cell_size);
  if (material.moves_as_one()) body.kind = BodyKind::rigid;
  body.total_mass = material.density * total;
  body.stiffness =
      !body.deforms() ? std::numeric_limits<double>::infinity() : material.density * speed * speed;
  body.initial_density = material.density;
  body.pressure_impedance = material.density * speed;
  body.shear_impedance = std::sqrt(material.density * shear_modulus(material));
  body.mean_mass = material.density * total / static_cast<double>(n);
  body.mean_edge = std::pow(total / static_cast<double>(n), 1.0 / D);
  body.id.resize(n);
  std::iota(body.id.begin(), body.id.end(), 0u);
  return body;
}

template Body<2> make_body<2>(const std::string&, const Material&, std::span<const double>,
                              std::span<const double>, std::span<const double>, const TileGrid<2>&);
template Body<3> make_body<3>(const std::string&, const Material&, std::span<const double>,
                              std::span<const double>, std::span<const double>, const TileGrid<3>&);

}  // namespace mpm
