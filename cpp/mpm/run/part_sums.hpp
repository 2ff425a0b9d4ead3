#pragma once
// What each body has: mass, centre, momentum, energy, angular momentum. Bodies of one group, the
// grains of an entry, count as one. And the balance of the angular momentum of all.
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "mpm/domain.hpp"

namespace mpm {

/// A column of `history.csv`.
struct Column {
  std::string_view name, unit, meaning;
};

/// The balance of angular momentum about the origin (ledger/angular_ledger.hpp), likewise.
inline constexpr auto total_columns = std::to_array<Column>({
    {"angular_momentum_x", "N m s", "of all that takes part, about the origin; 0 in 2D"},
    {"angular_momentum_y", "N m s", "likewise"},
    {"angular_momentum_z", "N m s", "likewise"},
    {"angular_impulse_gravity_x", "N m s", "that gravity has given it so far"},
    {"angular_impulse_gravity_y", "N m s", "likewise"},
    {"angular_impulse_gravity_z", "N m s", "likewise"},
    {"angular_impulse_loads_x", "N m s", "that loads on surfaces and body forces have given"},
    {"angular_impulse_loads_y", "N m s", "likewise"},
    {"angular_impulse_loads_z", "N m s", "likewise"},
    {"angular_impulse_walls_x", "N m s", "that walls have given, absorbing ones too"},
    {"angular_impulse_walls_y", "N m s", "likewise"},
    {"angular_impulse_walls_z", "N m s", "likewise"},
    {"angular_impulse_damping_x", "N m s", "that damping of motions has given"},
    {"angular_impulse_damping_y", "N m s", "likewise"},
    {"angular_impulse_damping_z", "N m s", "likewise"},
    {"angular_impulse_motion_x", "N m s", "that prescribed motions have given"},
    {"angular_impulse_motion_y", "N m s", "likewise"},
    {"angular_impulse_motion_z", "N m s", "likewise"},
    {"angular_momentum_removed_x", "N m s",
     "that eroded particles and those that left took with them"},
    {"angular_momentum_removed_y", "N m s", "likewise"},
    {"angular_momentum_removed_z", "N m s", "likewise"},
    {"angular_momentum_numerical_x", "N m s",
     "that the method has lost, negative: made; what the start and the impulses leave"},
    {"angular_momentum_numerical_y", "N m s", "likewise"},
    {"angular_momentum_numerical_z", "N m s", "likewise"},
});

struct PartSums {
  double mass = 0.0;                           // [kg]
  Vector3 centre, momentum;                    // [m]; [kg m/s]
  double kinetic = 0.0;                        // [J]
  Vector3 angular_momentum = Vector3::zero();  // about the centre [N m s]
  Matrix3 inertia{};                           // about the centre [kg m^2]
  bool prescribed = false;                     // is its motion
};

inline Vector3 velocity_of(const PartSums& part) {
  return (part.mass > 0.0 ? 1.0 / part.mass : 0.0) * part.momentum;
}
inline Vector3 spin_of(const PartSums& part, int dimension) {
  return spin_of(part.inertia, part.angular_momentum, dimension == 2 ? 4u : 7u);
}

/// Which of some sums each body counts for.
struct Grouping {
  std::span<const std::size_t> number;  // of each body
  std::size_t count;                    // of sums
};

/// Who has mass and motion of a body on nodes of its own: those, or the particles that are moved by
/// them, at the end of the last step; nodes have velocities of its middle. Both have the same mass
/// and centre.
enum class SumsOf : std::uint8_t { kept_nodes, particles };

/// Zeros where there are no particles. They depend on no order of patches or threads.
template <int D>
std::vector<PartSums> part_sums(Domain<D>& domain, const Grouping& grouping,
                                SumsOf of = SumsOf::kept_nodes);
/// Of each group, in the order of the groups' first bodies.
template <int D>
std::vector<PartSums> part_sums(Domain<D>& domain) {
  return part_sums(domain, Grouping{domain.group_of, domain.part_energies.size()});
}

/// Of each body by itself.
template <int D>
std::vector<PartSums> sums_of_bodies(Domain<D>& domain, SumsOf of);

/// Angular momentum about the origin of all, and of bodies whose motion is prescribed [N m s].
struct AngularTotals {
  Vector3 all = Vector3::zero(), prescribed = Vector3::zero();
};
AngularTotals angular_totals(const std::vector<PartSums>& parts);

/// As `total_columns`.
std::vector<double> balance_row(const AngularLedger& ledger, const AngularTotals& totals);

}  // namespace mpm
