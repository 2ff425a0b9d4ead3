#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// Give particles the affine part of their body's velocity, where the transfer has one: that which
/// a transfer to the nodes and back leaves as it is. Of a field that is linear in space, a spin
/// among them, it is the gradient. The lists must have been made.
template <int D>
void start_affine(Domain<D>& domain);

}  // namespace mpm
