#pragma once
// The contacts of the last step, a row for each pair of bodies that act on each other: where, along
// which normal, and with what force.
#include <array>
#include <vector>

#include "mpm/run/part_sums.hpp"

namespace mpm {

inline constexpr auto contact_columns = std::to_array<Column>({
    {"a", "1", "number of the body with the lower number"},
    {"b", "1", "of the other"},
    {"point_x", "m", "where it acts: mean of the nodes, by their impulses"},
    {"point_y", "m", "likewise"},
    {"point_z", "m", "likewise; 0 in 2D"},
    {"normal_x", "1", "from a to b: likewise, of length 1"},
    {"normal_y", "1", "likewise"},
    {"normal_z", "1", "likewise; 0 in 2D"},
    {"gap", "m", "the smallest distance of the surfaces, negative: overlap"},
    {"force_x", "N", "on a, mean of the last step"},
    {"force_y", "N", "likewise"},
    {"force_z", "N", "likewise; 0 in 2D"},
    {"slip", "m/s", "the work of friction over its impulse; 0 where nothing slips"},
});

/// As `contact_columns`, row by row, in the order of (a, b); none before the first step, and where
/// the tiles were connected anew since the last one: after a restart, a doubling of the cells, or
/// new velocities. By all ranks at once, each of which gets them all;
/// they depend on no number of threads or ranks.
template <int D>
std::vector<double> contact_rows(Domain<D>& domain);

}  // namespace mpm
