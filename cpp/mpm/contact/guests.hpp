#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Have what contact at this rank's tiles looks at of other ranks' particles: places, masses,
/// volumes and surfaces of those in cells around these tiles. They are rows of the pools, in the
/// lists of foreign patches by cell, which no stage but contact goes through. Patches that contact
/// of any rank looks at are `in_contact`. Call when lists were updated and tiles connected, by all
/// ranks at once.
template <int D>
void exchange_guests(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                     std::vector<ParticlePool<D>>& pools);

}  // namespace mpm
