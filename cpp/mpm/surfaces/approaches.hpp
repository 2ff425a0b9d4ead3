#pragma once
// How fast the surfaces of two bodies have approached each other where they began to touch: of
// those who touch again, or later, springs begin as softly (law.hpp).
#include "mpm/domain.hpp"

namespace mpm {

/// The way over which the spring of a touch begins at which the surfaces approach each other so
/// fast, w of (S4), if they have not met before [m].
template <int D>
double onset_of(const Domain<D>& domain, const SurfacePart<D>& part, Opposite opposite,
                double approach);

/// Surfaces::longest_onset, by how far points have moved in the step. All ranks together.
template <int D>
void bound_onsets(Domain<D>& domain);

/// Learn of those of the touches that have begun in the step, SurfacePart::begun, of all ranks.
template <int D>
void learn_approaches(Domain<D>& domain);

}  // namespace mpm
