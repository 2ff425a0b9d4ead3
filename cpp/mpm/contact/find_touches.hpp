#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// The particles that overlap another body, tile by tile; those nearer than `distance` [cells] to
/// it do.
template <int D>
void find_touches(Contact<D>& contact, const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools, double distance, Threads& threads);

/// How many cells away the surface of a patch's particles is felt, SurfaceSum::range().
template <int D>
std::uint8_t surface_range(const TileGrid<D>& grid, const ParticlePool<D>& pool,
                           const Patch<D>& patch);

}  // namespace mpm
