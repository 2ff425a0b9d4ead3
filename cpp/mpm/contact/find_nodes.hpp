#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Find the overlapped nodes with their normals, pairs and gaps, eq. (5). Needs mass and velocity
/// at the nodes, and the length of the step that begins.
template <int D>
void find_nodes(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                const std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                double time_step, Threads& threads);

}  // namespace mpm
