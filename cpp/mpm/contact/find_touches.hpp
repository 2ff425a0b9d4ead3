#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// The particles that overlap another body, tile by tile, of pairs that springs part; those nearer
/// to it than the settings' gap_distance do, and if it `presses` those nearer than what a pair is
/// pressed beside that.
template <int D>
void find_touches(Contact<D>& contact, const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                  Threads& threads, bool presses = true);

/// How many cells away the surface of a patch's particles is felt, SurfaceSum::range().
template <int D>
std::uint8_t surface_range(const TileGrid<D>& grid, const ParticlePool<D>& pool,
                           const Patch<D>& patch);

}  // namespace mpm
