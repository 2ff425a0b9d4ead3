#pragma once
// How fast the surfaces of two bodies have approached each other where they began to touch: of
// those who touch again, or later, springs begin as softly (law.hpp).
#include "mpm/domain.hpp"

namespace mpm {

/// The fastest so far of a body and an opposite; 0 if they have not touched [m/s].
template <int D>
double fastest_approach(const Surfaces<D>& surfaces, int body, Opposite opposite);

/// Learn of those of the touches that have begun in the step, SurfacePart::begun, of all ranks.
template <int D>
void learn_approaches(Domain<D>& domain);

}  // namespace mpm
