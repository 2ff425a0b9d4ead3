#pragma once
// Whom something touches, and the points of a surface that it feels: plain data.
#include <cstdint>

#include "mpm/math/vec.hpp"

namespace mpm {

/// Whom a point touches: a body by its number, a face of the box by -1 - (2 axis + side).
using Opposite = std::int32_t;
constexpr Opposite opposite_wall(int axis, int side) { return -1 - (2 * axis + side); }
constexpr bool is_wall(Opposite opposite) { return opposite < 0; }
constexpr int axis_of_wall(Opposite opposite) { return (-1 - opposite) / 2; }
constexpr int side_of_wall(Opposite opposite) { return (-1 - opposite) % 2; }

/// A point of another body that a point feels.
template <int D>
struct FeltPoint {
  std::uint32_t point = 0;
  double share = 0.0;        // of the weights of all that are felt
  Vec<double, D> slope;      // of the overlap with this point's place
  std::uint8_t mirrors = 0;  // its image is felt that these walls make (mirrored.hpp)
};

}  // namespace mpm
