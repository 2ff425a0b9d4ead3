#pragma once
// A particle over which the surface of another body lies.
#include <cstdint>

#include "mpm/math/vec.hpp"

namespace mpm {

/// A particle that overlaps another body. It is kept with the tile that it lies in. Lengths in
/// cells.
template <int D>
struct Touch {
  std::int32_t body, other;
  std::uint32_t entry;    // of the particle in its pool's lists
  Vec<double, D> x;       // from the tile's first node
  Vec<double, D> normal;  // of the other body's surface, into it
  double half;            // half its edge
  double surface;         // from its centre to its surface: the half edge, less what it is set back
  double half_of_other;
  double overlap;
  double to_middle;  // from its centre to the middle between the surfaces, along the normal

  /// Where it is pushed: both bodies get the force there, at the same nodes.
  Vec<double, D> place() const { return x + to_middle * normal; }
};

/// Where a tile's touches are.
struct TouchRange {
  std::uint32_t share = 0, first = 0, count = 0;  // of Contact::touches
};

}  // namespace mpm
