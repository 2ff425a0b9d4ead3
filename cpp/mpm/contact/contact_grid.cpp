#include "mpm/contact/contact_grid.hpp"

#include <algorithm>
#include <stdexcept>

namespace mpm {
namespace {

/// May a block reach any node that belongs to neighbour k?
template <int D>
bool reaches(const Reach& reach, int k) {
  bool any = true;
  const Index<D> o = Tile<D>::offset(k);
  for (int a = 0; a < D; ++a)
    any = any && (o[a] == 0 || (o[a] < 0 ? reach.before : reach.after) > 0);
  return any;
}

}  // namespace

template <int D>
void ContactGrid<D>::connect(TileGrid<D>& grid, const std::vector<Body<D>>& bodies) {
  if (grid.patches.size() > TileHolder::patches_max)
    throw std::length_error("bodies lie in more than 134 million tiles; give larger cells");
  holders_.clear();
  std::swap(last_tiles_, tiles_);
  tiles_.clear();
  for (Patch<D>& patch : grid.patches) patch.in_contact = false;
  auto tile_of = [&](const TileHolder& h) {
    Index<D> t = grid.patches[static_cast<std::size_t>(h.patch)].tile;
    const Index<D> o = Tile<D>::offset(h.neighbour);
    for (int a = 0; a < D; ++a) t[a] += o[a];
    return t;
  };
  for (std::size_t p = 0; p < grid.patches.size(); ++p)
    for (int k = 0; k < Tile<D>::neighbours; ++k)
      if (reaches<D>(grid.reach(), k)) holders_.emplace_back(grid.patches[p].body, p, k);
  std::sort(holders_.begin(), holders_.end(), [&](const TileHolder& x, const TileHolder& y) {
    const Index<D> tx = tile_of(x), ty = tile_of(y);
    if (tx != ty) return tile_less<D>(tx, ty);
    return x.patch < y.patch;  // by body, then in the order of the tiles
  });
  std::uint32_t kept = 0;
  for (std::size_t begin = 0, end = 0; begin < holders_.size(); begin = end) {
    const Index<D> tile = tile_of(holders_[begin]);
    bool several = false, deforms = false;
    for (end = begin; end < holders_.size() && tile_of(holders_[end]) == tile; ++end) {
      several = several || holders_[end].body != holders_[begin].body;
      deforms = deforms || !bodies[static_cast<std::size_t>(holders_[end].body)].rigid;
    }
    if (!several || !deforms) continue;
    ContactTile<D>& made = tiles_.emplace_back();
    made.tile = tile;
    made.first_holder = kept;
    made.holders = static_cast<std::uint32_t>(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      grid.patches[static_cast<std::size_t>(holders_[k].patch)].in_contact = true;
      holders_[kept++] = holders_[k];
    }
  }
  holders_.erase(holders_.begin() + kept, holders_.end());
  recall_tiles();
  // One body's tiles follow one another, so that its nodes and particles are at hand; of the bodies
  // around a tile the last, for a container that comes first meets all others.
  std::sort(tiles_.begin(), tiles_.end(), [&](const ContactTile<D>& x, const ContactTile<D>& y) {
    const std::uint32_t px = holders_[x.first_holder + x.holders - 1].patch;
    const std::uint32_t py = holders_[y.first_holder + y.holders - 1].patch;
    return px != py ? px < py : x.first_holder < y.first_holder;
  });
}

/// Take over what was known of the tiles before; both lists are in the order of the tiles then.
template <int D>
void ContactGrid<D>::recall_tiles() {
  const auto less = [](const ContactTile<D>& x, const ContactTile<D>& y) {
    return tile_less<D>(x.tile, y.tile);
  };
  std::sort(last_tiles_.begin(), last_tiles_.end(), less);
  auto last = last_tiles_.begin();
  for (ContactTile<D>& tile : tiles_) {
    while (last != last_tiles_.end() && less(*last, tile)) ++last;
    if (last == last_tiles_.end()) return;
    if (last->tile != tile.tile) continue;
    tile.known = last->known;
    tile.known_part = last->known_part;
    tile.first_known = last->first_known;
  }
}

template <int D>
void ContactGrid<D>::forget() {
  for (ContactTile<D>& tile : tiles_) tile.known = 0;
}

template <int D>
Crowd ContactGrid<D>::crowd(const TileGrid<D>& grid) const {
  Crowd most;
  for (const Part& part : parts_)
    for (const ContactNode& node : part.nodes) {
      if (static_cast<int>(node.sides) <= most.bodies) continue;
      most.bodies = node.sides;
      most.body = part.sides[node.first_side].body;
      const Vec<double, D> x = grid.position_of(place_of(grid, node));
      for (int a = 0; a < D; ++a) most.position[a] = x[a];
    }
  return most;
}

template class ContactGrid<2>;
template class ContactGrid<3>;

}  // namespace mpm
