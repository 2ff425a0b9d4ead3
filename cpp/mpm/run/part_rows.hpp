#pragma once
// Numbers of each body for `history.csv` and the manifest. Bodies of one group, the grains of an
// entry, count as one.
#include <array>
#include <string_view>
#include <vector>

#include "mpm/run/part_sums.hpp"

namespace mpm {

inline constexpr auto part_columns = std::to_array<Column>({
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
    {"spin_x", "rad/s", "of the rigid body that has its inertia and angular momentum; 0 in 2D"},
    {"spin_y", "rad/s", "likewise"},
    {"spin_z", "rad/s", "likewise"},
    {"internal", "J", "its share of `internal`, what eroded particles and others took not counted"},
    {"plastic", "J", "its share of `plastic`"},
    {"viscous", "J", "its share of `viscous`"},
    {"eroded_mass", "kg", "mass of its particles that have eroded"},
    {"contact_force_x", "N", "force of the last step on it from all other bodies"},
    {"contact_force_y", "N", "likewise"},
    {"contact_force_z", "N", "likewise; 0 in 2D"},
    {"load_force_x", "N", "force of the last step on it of loads on its surface"},
    {"load_force_y", "N", "likewise"},
    {"load_force_z", "N", "likewise; 0 in 2D"},
});

/// As `part_columns`, row by row, of the groups in the order of their first bodies. By all ranks at
/// once.
template <int D>
std::vector<double> part_rows(const Domain<D>& domain, const std::vector<PartSums>& parts);

}  // namespace mpm
