#pragma once
#include "mpm/contact/contact.hpp"
#include "mpm/contact/tile_bodies.hpp"

namespace mpm {

/// A pair of bodies at a node with its coefficient of friction, without normal and gap.
template <int D>
ContactPair<D> new_pair(const std::vector<Body<D>>& bodies, const ContactSettings& settings,
                        std::span<const BodyAtNode<D>> sides, std::uint16_t r, std::uint16_t s);

/// Does a pair pass the test of the gap, eq. (5), if that is asked for?
template <int D>
bool passes_gap_test(const ContactPair<D>& pair, const ContactSettings& settings, double cell_size);

/// Normals, gaps and frictions of the pairs at a node whose sides are known, from the particles
/// around.
template <int D>
void find_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                const ContactSettings& settings, TileBodies<D>& around, ContactPart<D>& part,
                const ContactNode& node);

}  // namespace mpm
