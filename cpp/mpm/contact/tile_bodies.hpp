#pragma once
// The bodies around a tile, while the tile's overlapped nodes are found.
#include "mpm/contact/tile_particles.hpp"
#include "mpm/contact/tile_touches.hpp"

namespace mpm {

template <int D>
struct TileBody {
  std::int32_t body;
  std::uint32_t first_holder, holders;
  std::uint64_t nodes;  // where it has mass, a bit each by Tile<D>::cell
  TileParticles<D> particles;

  /// Its own of all holders.
  std::span<const TileHolder> of(const std::vector<TileHolder>& all) const {
    return {&all[first_holder], holders};
  }
};

/// Scratch of one thread, not counted among the bytes of the contact.
template <int D>
struct TileBodies {
  std::vector<TileBody<D>> bodies;  // the first `count` are in use
  std::size_t count = 0;
  std::uint64_t overlapped = 0;    // nodes at which two or more have mass
  std::vector<HeldNodes<D>> held;  // by the holders, in the order of the tile's
  TileTouches<D> touches;          // with springs

  std::span<TileBody<D>> all() { return {bodies.data(), count}; }
  std::span<const TileBody<D>> all() const { return {bodies.data(), count}; }
  std::span<const HeldNodes<D>> held_by(const TileBody<D>& body) const {
    return {&held[body.first_holder - bodies.front().first_holder], body.holders};
  }
  TileBody<D>& with(std::int32_t body) {
    return *std::ranges::find(all(), body, &TileBody<D>::body);
  }
};

/// The bodies around a tile and the nodes at which they overlap.
template <int D>
void look_around(const Contact<D>& contact, const TileGrid<D>& grid, const ContactTile<D>& tile,
                 TileBodies<D>& found);

/// How many of these nodes there are, and by how many bodies they are held at most.
template <int D>
void count_overlapped(const TileBodies<D>& around, ContactPart<D>& part);

}  // namespace mpm
