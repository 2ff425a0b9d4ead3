#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Bodies that overlap at the start do not push each other: the surface of each particle that
/// overlaps another body is set back by that (decision 0053), unless the two are bonded. Needs
/// find_touches().
template <int D>
void set_back_surfaces(Contact<D>& contact, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                       double cell_size);

}  // namespace mpm
