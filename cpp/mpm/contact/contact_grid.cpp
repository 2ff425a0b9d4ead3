#include "mpm/contact/contact_grid.hpp"

#include <algorithm>
#include <bit>

namespace mpm {
namespace {

/// Does a block reach any node that belongs to neighbour k?
template <int D>
bool reaches(const BlockShape<D>& shape, int k) {
  bool any = true;
  const Index<D> o = Tile<D>::offset(k);
  for (int a = 0; a < D; ++a) any = any && (o[a] >= 0 || shape.margin > 0);
  return any;
}

}  // namespace

template <int D>
void ContactGrid<D>::connect(TileGrid<D>& grid, const std::vector<Body<D>>& bodies) {
  holders_.clear();
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
      if (reaches<D>(grid.shape, k))
        holders_.push_back(
            {grid.patches[p].body, static_cast<std::int32_t>(p), static_cast<std::uint8_t>(k)});
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
    tiles_.push_back({tile, kept, static_cast<std::uint32_t>(end - begin)});
    for (std::size_t k = begin; k < end; ++k) {
      grid.patches[static_cast<std::size_t>(holders_[k].patch)].in_contact = true;
      holders_[kept++] = holders_[k];
    }
  }
  holders_.resize(kept);
}

template <int D>
std::uint32_t ContactGrid<D>::sides_at(TileGrid<D>& grid, const ContactTile<D>& tile,
                                       const Index<D>& node, Side<D>* sides) {
  std::uint32_t count = 0;
  Index<D> global = grid.first_cell(tile.tile), image;
  for (int a = 0; a < D; ++a) global[a] += node[a];
  if (grid.walls.mirrored(global, image)) return 0;  // it follows its image
  const std::uint32_t end = tile.first_holder + tile.holders;
  for (std::uint32_t first = tile.first_holder, next = first; first < end; first = next) {
    const int body = holders_[first].body;
    bool found = false;
    for (next = first; next < end && holders_[next].body == body; ++next) {
      if (found || !holds_node<D>(grid.shape, holders_[next], node)) continue;
      found = true;
      const NodeBlock<D> block = grid.block(static_cast<std::size_t>(holders_[next].patch));
      const int at = node_in_holder<D>(grid.shape, holders_[next], node);
      if (!(block.mass()[at] > 0.0)) continue;
      if (sides) {
        Side<D>& side = sides[count];
        side.body = body;
        side.first_copy = first;
        side.mass = block.mass()[at];
        side.mapped_mass = side.mass;
        side.prescribed = false;
        for (int a = 0; a < D; ++a) side.mapped[a] = block.velocity(a)[at];
        side.velocity = side.mapped;
        side.base = side.increment = Vec<double, D>::zero();
      }
      ++count;
    }
    if (sides && found && count > 0 && sides[count - 1].body == body)
      sides[count - 1].copies = next - first;
  }
  return count;
}

template <int D>
void ContactGrid<D>::find(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                          const std::vector<double>& stiffness, const ContactSettings& settings,
                          Threads& threads) {
  counts_.assign(tiles_.size() + 1, {});
  threads.for_each(tiles_.size(), [&](std::size_t t) {
    TileCounts c{};
    // The nodes that belong to a tile are all but those at its upper ends, the next tile's first.
    for (int cell = 0; cell < Tile<D>::cell_count; ++cell) {
      const std::uint32_t sides = sides_at(grid, tiles_[t], Tile<D>::cell_index(cell), nullptr);
      if (sides < 2) continue;
      ++c.nodes;
      c.sides += sides;
      c.pairs += pair_count(sides);
      c.overlapped |= std::uint64_t{1} << cell;
    }
    counts_[t + 1] = c;
  });
  for (std::size_t t = 1; t < counts_.size(); ++t) {
    counts_[t].nodes += counts_[t - 1].nodes;
    counts_[t].sides += counts_[t - 1].sides;
    counts_[t].pairs += counts_[t - 1].pairs;
  }
  nodes_.resize(counts_.back().nodes);
  sides_.resize(counts_.back().sides);
  pairs_.resize(counts_.back().pairs);
  nodes_max_ = std::max(nodes_max_, nodes_.size());

  threads.for_each(tiles_.size(), [&](std::size_t t) {
    TileCounts c = counts_[t];
    for (std::uint64_t left = counts_[t + 1].overlapped; left != 0; left &= left - 1) {
      const int cell = std::countr_zero(left);
      const Index<D> index = Tile<D>::cell_index(cell);
      const std::uint32_t count = sides_at(grid, tiles_[t], index, &sides_[c.sides]);
      ContactNode& node = nodes_[c.nodes];
      node.cell = static_cast<std::uint16_t>(cell);
      node.sides = static_cast<std::uint16_t>(count);
      node.first_side = c.sides;
      node.first_pair = c.pairs;
      Index<D> global = grid.first_cell(tiles_[t].tile);
      for (int a = 0; a < D; ++a) global[a] += index[a];
      node.held = grid.walls.held(global);
      node.energy = node.force_work = 0.0;
      const Vector3 x = in_space<D>(grid.position_of(global));
      for (std::uint32_t k = c.sides; k < c.sides + count; ++k) {
        const Body<D>& body = bodies[static_cast<std::size_t>(sides_[k].body)];
        sides_[k].prescribed = body.prescribed;
        if (body.prescribed) sides_[k].increment = from_space<D>(body.motion.increment_at(x));
      }
      sort_sides<D>({&sides_[c.sides], count});
      find_pairs(grid, bodies, stiffness, settings, node);
      ++c.nodes;
      c.sides += count;
      c.pairs += pair_count(count);
    }
  });
  share_rigid_masses(bodies);
  for (const ContactNode& node : nodes_)
    bodies_max_ = std::max(bodies_max_, static_cast<int>(node.sides));
}

/// Give bodies whose motion is prescribed the masses with which they meet the others at a node:
/// infinite ones, so that the reduced mass is that of the others; but where such a body has less
/// than a tenth of the others' volume at the node, in proportion, so that a node which it has only
/// just reached, inside the others, is not held.
template <int D>
void harden(const std::vector<Body<D>>& bodies, std::span<Side<D>> sides) {
  constexpr double full = 0.1;
  const auto density = [&](const Side<D>& side) {
    return bodies[static_cast<std::size_t>(side.body)].initial_density;
  };
  double mass = 0.0, volume = 0.0;
  for (const Side<D>& side : sides)
    if (!side.prescribed) {
      mass += side.mapped_mass;
      volume += side.mapped_mass / density(side);
    }
  for (Side<D>& side : sides) {
    if (!side.prescribed) continue;
    const double share = side.mapped_mass / density(side) / (full * volume);
    side.mass =
        share < 1.0 ? mass * share / (1.0 - share) : std::numeric_limits<double>::infinity();
  }
}

template <int D>
void ContactGrid<D>::share_rigid_masses(const std::vector<Body<D>>& bodies) {
  if (std::none_of(bodies.begin(), bodies.end(), [](const Body<D>& b) { return b.rigid; })) return;
  rigid_share_.assign(bodies.size(), 0.0);
  for (const ContactNode& node : nodes_) harden(bodies, {&sides_[node.first_side], node.sides});
  for (const Side<D>& side : sides_) rigid_share_[static_cast<std::size_t>(side.body)] += side.mass;
  for (Side<D>& side : sides_) {
    const auto b = static_cast<std::size_t>(side.body);
    if (bodies[b].rigid && !side.prescribed) side.mass /= rigid_share_[b] / bodies[b].total_mass;
  }
}

template class ContactGrid<2>;
template class ContactGrid<3>;

}  // namespace mpm
