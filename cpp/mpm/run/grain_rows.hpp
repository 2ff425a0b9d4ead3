#pragma once
// What each body has, all grains one by one: how it lies and moves, and what pushes it.
#include <array>
#include <vector>

#include "mpm/run/part_sums.hpp"

namespace mpm {

inline constexpr auto grain_columns = std::to_array<Column>({
    {"mass", "kg", "mass of the particles that take part"},
    {"centre_x", "m", "its mass centre"},
    {"centre_y", "m", "likewise"},
    {"centre_z", "m", "likewise; 0 in 2D"},
    {"velocity_x", "m/s", "velocity of the mass centre"},
    {"velocity_y", "m/s", "likewise"},
    {"velocity_z", "m/s", "likewise; 0 in 2D"},
    {"spin_x", "rad/s", "of the rigid body that has its inertia and angular momentum; 0 in 2D"},
    {"spin_y", "rad/s", "likewise"},
    {"spin_z", "rad/s", "likewise"},
    {"force_x", "N", "force of the last step on it from all other bodies"},
    {"force_y", "N", "likewise"},
    {"force_z", "N", "likewise; 0 in 2D"},
    {"contacts", "1", "number of bodies that it acts on"},
});

/// As `grain_columns`, row by row, of the bodies in their order. By all ranks at once.
/// @param contacts the rows of contact_rows()
template <int D>
std::vector<double> grain_rows(Domain<D>& domain, const std::vector<double>& contacts);

}  // namespace mpm
