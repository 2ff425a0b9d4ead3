#include "mpm/contact/candidates.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "mpm/contact/tile_particles.hpp"

namespace mpm {
namespace {

/// May a block reach any node that belongs to neighbour k?
template <int D>
bool reaches(const Reach& reach, int k) {
  // Neighbour k's nodes lie on one side of the block along each axis with an offset: with the
  // linear basis a block reaches those behind it alone, with GIMP those before it too.
  bool any = true;
  const Index<D> o = Tile<D>::offset(k);
  for (int a = 0; a < D; ++a)
    any = any && (o[a] == 0 || (o[a] < 0 ? reach.before : reach.after) > 0);
  return any;
}

/// Take over what was cached of the tiles before; both lists are in the order of the tiles then.
template <int D>
void reuse_tiles(std::vector<ContactTile<D>>& last_tiles, std::vector<ContactTile<D>>& tiles) {
  const auto less = [](const ContactTile<D>& x, const ContactTile<D>& y) {
    return tile_less<D>(x.tile, y.tile);
  };
  // They were last sorted by body; the new ones get there at the end of connect_tiles().
  std::sort(last_tiles.begin(), last_tiles.end(), less);
  auto last = last_tiles.begin();
  for (ContactTile<D>& tile : tiles) {
    while (last != last_tiles.end() && less(*last, tile)) ++last;
    if (last == last_tiles.end()) return;
    if (last->tile != tile.tile) continue;
    tile.cached = last->cached;
    tile.cached_part = last->cached_part;
    tile.first_cached = last->first_cached;
  }
}

/// The number of each tile's neighbours, -1 for those that are none of contact's; with other ranks
/// all others are foreign.
template <int D>
void find_around(Contact<D>& contact) {
  const auto& tiles = contact.tiles;
  auto& sorted = contact.sorted_tiles;
  sorted.resize(tiles.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  const auto place = [&](std::int32_t t) -> const Index<D>& {
    return tiles[static_cast<std::size_t>(t)].tile;
  };
  std::ranges::sort(sorted, tile_less<D>, place);
  contact.around.resize(tiles.size());
  const auto none = static_cast<std::int32_t>(tiles.size());
  auto& foreign = contact.foreign_tiles;
  foreign.clear();
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const Index<D> wanted = Tile<D>::beside(tiles[t].tile, k);
      const auto found = std::ranges::lower_bound(sorted, wanted, tile_less<D>, place);
      contact.around[t][static_cast<std::size_t>(k)] =
          found != sorted.end() && place(*found) == wanted ? *found : -1;
      if (tiles[t].beside_others && contact.around[t][static_cast<std::size_t>(k)] < 0)
        foreign.push_back({wanted});
    }
  std::ranges::sort(foreign, tile_less<D>, &ForeignTile<D>::tile);
  const auto same = std::ranges::unique(foreign, {}, &ForeignTile<D>::tile);
  foreign.erase(same.begin(), same.end());
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (int k = 0; tiles[t].beside_others && k < Tile<D>::neighbours; ++k) {
      std::int32_t& number = contact.around[t][static_cast<std::size_t>(k)];
      if (number >= 0) continue;
      const Index<D> wanted = Tile<D>::beside(tiles[t].tile, k);
      const auto found =
          std::ranges::lower_bound(foreign, wanted, tile_less<D>, &ForeignTile<D>::tile);
      number = none + static_cast<std::int32_t>(found - foreign.begin());
    }
}

/// What other ranks have around the tiles: whose particles are looked at, and who is told.
template <int D>
void find_others(Contact<D>& contact, const TileGrid<D>& grid, Response response) {
  contact.wanted.clear();
  if (grid.partition.alone()) return;
  const int range = TileParticles<D>::range_max;
  const Reach reach = may_spring(response) ? Reach{range, range, 0.0} : grid.reach();
  std::vector<std::uint64_t> cells(grid.patches.size(), 0);
  for (ContactTile<D>& tile : contact.tiles) {
    tile.beside_others = tile.held_by_others = false;
    for (int k = 0; k < Tile<D>::neighbours && !tile.beside_others; ++k)
      tile.beside_others = !grid.partition.owns(Tile<D>::beside(tile.tile, k));
    for (std::uint32_t h = 0; h < tile.holders; ++h) {
      const TileHolder& holder = contact.holders[tile.first_holder + h];
      if (!grid.patches[holder.patch].foreign) continue;
      tile.held_by_others = true;
      const Index<D> offset = Tile<D>::offset(Tile<D>::neighbours - 1 - holder.neighbour);
      cells[holder.patch] |= cells_in_reach<D>(~std::uint64_t{0}, offset, reach);
    }
  }
  for (std::uint32_t p = 0; p < cells.size(); ++p)
    if (grid.patches[p].foreign && grid.patches[p].in_contact)
      contact.wanted.push_back({p, cells[p]});
}

/// Every patch with every tile where it may have nodes, or particles that others meet.
template <int D>
void list_holders(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies, bool leaves_surfaces,
                  Response response, std::vector<TileHolder>& holders) {
  holders.clear();
  // Particles are nearer than they reach: with springs all tiles around see a patch.
  const Reach reach = may_spring(response) ? Reach{1, 1, 0.0} : grid.reach();
  for (std::size_t p = 0; p < grid.patches.size(); ++p) {
    const Body<D>& body = bodies[static_cast<std::size_t>(grid.patches[p].body)];
    if (leaves_surfaces && body.kind != BodyKind::deformable) continue;
    for (int k = 0; k < Tile<D>::neighbours; ++k)
      // By tiles, not by the boxes of blocks: those change too often to sort this list each time
      // (decision 0013).
      if (reaches<D>(reach, k)) holders.emplace_back(grid.patches[p].body, p, k);
  }
}

}  // namespace

template <int D>
void connect_tiles(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                   Response response) {
  auto& holders = contact.holders;
  auto& tiles = contact.tiles;
  if (grid.patches.size() > TileHolder::patches_max)
    throw std::length_error("bodies lie in more than 134 million tiles; give larger cells");
  std::swap(contact.last_tiles, tiles);
  tiles.clear();
  forget_nodes(contact);  // which count in these tiles
  contact.has_rigid = contact.has_free_rigid = false;
  // By what the case has: ranks may not know alike who is left.
  for (const Body<D>& body : bodies) {
    if (contact.leaves_surfaces) break;
    contact.has_rigid = contact.has_rigid || !body.deforms();
    contact.has_free_rigid = contact.has_free_rigid || body.is_free_rigid();
  }
  // Set below for the patches around tiles that stay: for others no masses are looked at.
  for (Patch<D>& patch : grid.patches) patch.in_contact = false;
  auto tile_of = [&](const TileHolder& h) {
    return Tile<D>::beside(grid.patches[static_cast<std::size_t>(h.patch)].tile,
                           static_cast<int>(h.neighbour));
  };
  list_holders(grid, bodies, contact.leaves_surfaces, response, holders);
  std::sort(holders.begin(), holders.end(), [&](const TileHolder& x, const TileHolder& y) {
    const Index<D> tx = tile_of(x), ty = tile_of(y);
    if (tx != ty) return tile_less<D>(tx, ty);
    return x.patch < y.patch;  // by body, then in the order of the tiles
  });
  std::uint32_t kept = 0;
  for (std::size_t begin = 0, end = 0; begin < holders.size(); begin = end) {
    const Index<D> tile = tile_of(holders[begin]);
    bool several = false, deforms = false;
    for (end = begin; end < holders.size() && tile_of(holders[end]) == tile; ++end) {
      several = several || holders[end].body != holders[begin].body;
      deforms = deforms || bodies[static_cast<std::size_t>(holders[end].body)].deforms();
    }
    // Bodies that do not deform have no stress that could part them, and do not act on each other.
    if (!several || !deforms) continue;
    // Who has the tile knows all that is around it.
    if (!grid.partition.alone() && !grid.partition.owns(tile)) continue;
    ContactTile<D>& made = tiles.emplace_back();
    made.tile = tile;
    made.first_holder = kept;
    made.holders = static_cast<std::uint32_t>(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      grid.patches[static_cast<std::size_t>(holders[k].patch)].in_contact = true;
      holders[kept++] = holders[k];
    }
  }
  holders.erase(holders.begin() + kept, holders.end());
  reuse_tiles(contact.last_tiles, tiles);
  // One body's tiles follow one another, so that its nodes and particles are at hand; of the bodies
  // around a tile the last, for a container that comes first meets all others.
  std::sort(tiles.begin(), tiles.end(), [&](const ContactTile<D>& x, const ContactTile<D>& y) {
    const std::uint32_t px = holders[x.first_holder + x.holders - 1].patch;
    const std::uint32_t py = holders[y.first_holder + y.holders - 1].patch;
    return px != py ? px < py : x.first_holder < y.first_holder;
  });
  find_others(contact, grid, response);
  if (may_spring(response)) find_around(contact);
}

template void connect_tiles<2>(Contact<2>&, TileGrid<2>&, const std::vector<Body<2>>&, Response);
template void connect_tiles<3>(Contact<3>&, TileGrid<3>&, const std::vector<Body<3>>&, Response);

}  // namespace mpm
