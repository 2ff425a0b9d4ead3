#pragma once
// The fields of a node lie side by side in a record, so that whoever wants a node touches one cache
// line and moves all its fields at once.
#include <cstddef>

#include "mpm/math/host_device.hpp"

namespace mpm {

/// A record is two halves of four numbers: mass and velocity, then the force and, of matter that
/// flows, the volume. In 2D the last of a vector's three places stays empty.
inline constexpr int half_record = 4;
inline constexpr int record = 2 * half_record;
inline constexpr int mass_at = 0, velocity_at = 1, force_at = half_record, volume_at = record - 1;
/// Fields whose time is over before another's begins share its place: momentum is there until
/// velocities are found; what slip walls mirror of the weight until forces are mapped, the forces
/// until nodes are advanced, the increments of velocity until MUSL remaps, then the remapped
/// momentum and velocity.
inline constexpr int momentum_at = velocity_at, ghost_weight_at = force_at, increment_at = force_at,
                     remapped_at = force_at;

/// Nodes whose numbers begin `width` apart.
template <int width>
struct Nodes {
  double* data;
  MPM_HD double* operator[](int node) const { return data + std::ptrdiff_t{node} * width; }
  /// The same, counted from a node, or from a number of each.
  MPM_HD Nodes from(int node) const { return {(*this)[node]}; }
  MPM_HD Nodes at(int number) const { return {data + number}; }
};
/// Behind all records of a patch at a wall that touches, so many numbers of each node: a half each
/// of the springs' forces, stiffnesses and energies, a number for each normal; then, a half for
/// each normal, the force of that face with its friction.
inline constexpr int wall_record = 3 * half_record;
inline constexpr int spring_force_at = 0, spring_stiffness_at = half_record,
                     spring_energy_at = 2 * half_record;

using NodeRecords = Nodes<record>;
using HalfRecords = Nodes<half_record>;
using WallRecords = Nodes<wall_record>;

/// One number of each node.
template <int width>
struct NodeField {
  double* first;
  MPM_HD double& operator[](int node) const { return first[std::ptrdiff_t{node} * width]; }
};

}  // namespace mpm
