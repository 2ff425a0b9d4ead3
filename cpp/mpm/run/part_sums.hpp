#pragma once
// What each body has: mass, centre, momentum, energy, angular momentum. Bodies of one group, the
// grains of an entry, count as one.
#include <array>
#include <string_view>
#include <vector>

#include "mpm/domain.hpp"

namespace mpm {

/// A number of a body, for `history.csv`.
struct PartColumn {
  std::string_view name, unit, meaning;
};
inline constexpr auto part_columns = std::to_array<PartColumn>({
    {"mass", "kg", "mass of the particles that take part"},
    {"centre_x", "m", "its mass centre"},
    {"centre_y", "m", "likewise"},
    {"centre_z", "m", "likewise; 0 in 2D"},
    {"velocity_x", "m/s", "velocity of the mass centre"},
    {"velocity_y", "m/s", "likewise"},
    {"velocity_z", "m/s", "likewise; 0 in 2D"},
    {"momentum_x", "N s", "its momentum"},
    {"momentum_y", "N s", "likewise"},
    {"momentum_z", "N s", "likewise; 0 in 2D"},
    {"kinetic", "J", "its kinetic energy"},
    {"angular_momentum_x", "N m s", "its angular momentum about its mass centre; 0 in 2D"},
    {"angular_momentum_y", "N m s", "likewise"},
    {"angular_momentum_z", "N m s", "likewise"},
});

/// Those numbers of each group, in the order of the groups' first bodies, row by row; zeros for one
/// without particles. They depend on no order of patches or threads.
template <int D>
std::vector<double> part_sums(Domain<D>& domain);

}  // namespace mpm
