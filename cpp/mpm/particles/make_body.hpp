#pragma once
// A body from what the user gives of its particles.
#include <span>
#include <string>

#include "mpm/grid/tile_grid.hpp"
#include "mpm/particles/body.hpp"

namespace mpm {

/// Throws std::invalid_argument, naming `what`, if any of the numbers is not finite.
void check_finite(std::span<const double> values, const std::string& what);

/// Particles of a material at rest: positions [m] and velocities [m/s] are (n, D) row by row, or
/// one row of velocities for all; volumes [m^3] n values, or one for all. Throws
/// std::invalid_argument, in one sentence, for what is not so.
template <int D>
Body<D> make_body(const std::string& name, const Material& material,
                  std::span<const double> positions, std::span<const double> velocities,
                  std::span<const double> volumes, const TileGrid<D>& grid);

}  // namespace mpm
