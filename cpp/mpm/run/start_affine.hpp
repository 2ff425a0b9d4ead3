#pragma once
#include "mpm/domain.hpp"

namespace mpm {

inline constexpr int all_bodies = -1;

/// Give the particles of a body, or of all, the affine part of its velocity, where the transfer has
/// one: that which a transfer to the nodes and back leaves as it is. Of a field that is linear in
/// space, a spin among them, it is the gradient. The lists must be those of the particles' places.
template <int D>
void start_affine(Domain<D>& domain, int body = all_bodies);

}  // namespace mpm
