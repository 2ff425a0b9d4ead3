#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Bodies that overlap at the start do not push each other: where a particle reaches beyond one of
/// another body along the normal of any pair with springs, the surfaces of both are set back by
/// half of it (decision 0053). Needs the nodes of find_nodes().
template <int D>
void set_back_surfaces(Contact<D>& contact, const TileGrid<D>& grid,
                       const std::vector<Body<D>>& bodies, std::vector<ParticlePool<D>>& pools,
                       const ContactSettings& settings, Threads& threads);

}  // namespace mpm
