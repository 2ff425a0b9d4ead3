#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// Give the particles of bodies, by their numbers, or of all if none are given, the affine part of
/// its velocity, where the transfer has one: that which a transfer to the nodes and back leaves as
/// it is. Of a field that is linear in space, a spin among them, it is the gradient. The lists must
/// be those of the particles' places.
template <int D>
void start_affine(Domain<D>& domain, const std::vector<bool>& bodies = {});

}  // namespace mpm
