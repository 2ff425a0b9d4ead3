#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// The particles that overlap another body, tile by tile; those nearer than `distance` [cells] to
/// it do.
template <int D>
void find_touches(Contact<D>& contact, const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools, double distance, Threads& threads);

}  // namespace mpm
