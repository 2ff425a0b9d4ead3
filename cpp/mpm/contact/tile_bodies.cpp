// Who is around a tile, and where two or more are.
#include "mpm/contact/tile_bodies.hpp"

#include <algorithm>
#include <bit>

namespace mpm {

template <int D>
void look_around(const Contact<D>& contact, const TileGrid<D>& grid, const ContactTile<D>& tile,
                 TileBodies<D>& found) {
  found.count = 0;
  found.held.clear();
  std::uint64_t once = 0;
  found.overlapped = 0;
  const std::uint32_t end = tile.first_holder + tile.holders;
  for (std::uint32_t h = tile.first_holder; h < end;) {
    if (found.count == found.bodies.size()) found.bodies.emplace_back();
    TileBody<D>& at = found.bodies[found.count++];
    at.body = contact.holders[h].body;
    at.first_holder = h;
    at.nodes = 0;
    for (; h < end && contact.holders[h].body == at.body; ++h) {
      const std::uint64_t nodes = contact.masses.in_tile(grid, contact.holders[h]);
      found.held.push_back({nodes});
      at.nodes |= nodes;
    }
    at.holders = h - at.first_holder;
    // The holders are in the order of the bodies, so each body comes once: a node that has been
    // seen before and is seen again is overlapped, whatever the number of bodies.
    found.overlapped |= once & at.nodes;
    once |= at.nodes;
  }
  if (!grid.walls.exist) return;
  for (std::uint64_t left = found.overlapped; left != 0; left &= left - 1) {
    const int cell = std::countr_zero(left);
    Index<D> node = Tile<D>::cell_index(cell);
    for (std::size_t a = 0; a < D; ++a) node[a] += grid.first_cell(tile.tile)[a];
    // A node beyond a wall follows its image.
    if (grid.walls.image(node)) found.overlapped &= ~(std::uint64_t{1} << cell);
  }
}

template <int D>
void count_overlapped(const TileBodies<D>& around, ContactPart<D>& part) {
  part.overlapped += static_cast<std::size_t>(std::popcount(around.overlapped));
  // Nodes that no more bodies hold than were seen are left out at once.
  int most = std::max(part.bodies_max, 1);
  for (std::uint64_t left = around.count > static_cast<std::size_t>(most) ? around.overlapped : 0;
       left != 0; left &= left - 1) {
    const int cell = std::countr_zero(left);
    int here = 0;
    for (const TileBody<D>& at : around.all()) here += at.nodes >> cell & 1u ? 1 : 0;
    most = std::max(most, here);
  }
  if (around.overlapped != 0) part.bodies_max = std::max(most, 2);
}

template void look_around<2>(const Contact<2>&, const TileGrid<2>&, const ContactTile<2>&,
                             TileBodies<2>&);
template void look_around<3>(const Contact<3>&, const TileGrid<3>&, const ContactTile<3>&,
                             TileBodies<3>&);
template void count_overlapped<2>(const TileBodies<2>&, ContactPart<2>&);
template void count_overlapped<3>(const TileBodies<3>&, ContactPart<3>&);

}  // namespace mpm
