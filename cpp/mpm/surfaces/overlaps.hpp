#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// The faces of the box and the bodies that the points of a part overlap, and what springs push
/// these with. Needs find_near_points().
template <int D>
void find_overlaps(const Domain<D>& domain, SurfacePart<D>& part);

/// Before the first step: the surfaces of points that overlap faces or bodies are set back by that,
/// so that nothing is pushed.
template <int D>
void set_back_overlaps(Domain<D>& domain);

}  // namespace mpm
