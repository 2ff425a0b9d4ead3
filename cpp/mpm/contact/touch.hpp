#pragma once
// A particle over which the surface of another body lies.
#include <cmath>
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
  double reach;  // how far along an axis a node may be that gets some of its force, at most

  bool reaches(const Vec<double, D>& node) const {
    bool near = true;
    for (int a = 0; a < D; ++a) near = near && std::abs(node[a] - x[a]) < reach;
    return near;
  }
};

/// Where a tile's touches are.
struct TouchRange {
  std::uint32_t share = 0, first = 0, count = 0;  // of Contact::touches
};

}  // namespace mpm
