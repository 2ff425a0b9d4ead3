#pragma once
// Surfaces of bodies of which particles have failed. Contact points on these are no surface any
// more, and only walls stop them; particles beside them, as far off as neighbours of a lattice,
// have points on the faces between: squares (in 2D lines) of the edge of the particle, square to
// the way from one to the other in the body.
#include "mpm/domain.hpp"

namespace mpm {

/// Behind a step, whose overlaps are known; by all ranks.
template <int D>
void uncover(Domain<D>& domain);

}  // namespace mpm
