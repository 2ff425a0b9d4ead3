#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Bodies that overlap at the start do not push each other: the surface of each particle that
/// overlaps another body is set back by that (decision 0053). Needs find_touches().
template <int D>
void set_back_surfaces(Contact<D>& contact, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, double cell_size);

}  // namespace mpm
