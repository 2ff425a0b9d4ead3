#pragma once
// Particles whose nodes lie in space, and the surfaces that they press (pressing.hpp): plain data.
#include <cstdint>
#include <vector>

#include "mpm/layout/tile.hpp"
#include "mpm/math/tensor.hpp"
#include "mpm/surfaces/opposite.hpp"
#include "mpm/walls/face_impulses.hpp"

namespace mpm {

/// A contact point and the tile of space that it lies in.
template <int D>
struct PointInTile {
  Index<D> tile{};
  std::int32_t body = 0, face = 0;
  std::uint32_t point = 0;
};

/// A particle whose nodes lie in space and that overlaps a body with a surface (pressing.hpp).
template <int D>
struct PressingTouch {
  std::uint32_t row = 0;
  Opposite opposite = 0;
  double overlap = 0.0;      // [m]
  double sunk = 0.0;         // of the particle's middle, as the overlap of a contact point [m]
  double area = 0.0;         // of its face at the start [m^2; in 2D m times 1 m]
  double stiffness = 0.0;    // [N/m]
  double pressed_in = 0.0;   // of the overlap, what the spring is pressed in by [m]
  Vec<double, D> slope;      // of the overlap with the particle's place, backwards
  Vec<double, D> arm;        // from the particle to the place of contact [m]
  Vec<double, D> push, rub;  // on the particle [N]
  double rub_work = 0.0;     // taken by friction in the step [J]
  std::uint32_t first_felt = 0, felt_count = 0;  // of PressingPatch::felt
};
/// Those of a patch.
template <int D>
struct PressingPatch {
  std::uint32_t patch = 0;
  std::uint64_t order = 0;  // of sums: behind all parts, by tile
  std::vector<PressingTouch<D>> touches;
  std::vector<FeltPoint<D>> felt;              // by touches
  double stored_push = 0.0, stored_rub = 0.0;  // in the springs [J]
  // By the walls of the box in the coming step, as of a part.
  FaceImpulses<D> by_walls;
  Vector3 moment_by_walls = Vector3::zero();
  bool at_walls = false;
};

/// What passes through planes of symmetry between particles and surfaces in the coming step, of
/// this rank.
template <int D>
struct PressedWalls {
  FaceImpulses<D> faces;             // [N]
  Vector3 moment = Vector3::zero();  // about the origin [N m]
  bool any = false;
};

}  // namespace mpm
