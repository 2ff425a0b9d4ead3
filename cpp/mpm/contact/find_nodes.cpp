// The overlapped nodes of a step: who has mass there.
#include <algorithm>
#include <bit>
#include <utility>

#include "mpm/contact/contact_grid.hpp"

namespace mpm {
namespace {

/// A hash that goes on with another number (Knuth 1973, section 6.4).
std::uint64_t mix(std::uint64_t hash, std::uint64_t x) {
  hash = (hash ^ x) * 0x9E3779B97F4A7C15u;
  return hash ^ hash >> 32;
}

template <int D>
TileBodies<D>& bodies_around() {
  thread_local TileBodies<D> around;
  return around;
}

}  // namespace

template <int D>
void ContactGrid<D>::look_around(const TileGrid<D>& grid, const ContactTile<D>& tile,
                                 TileBodies<D>& found) const {
  found.count = 0;
  found.held.clear();
  std::uint64_t once = 0;
  found.overlapped = 0;
  const std::uint32_t end = tile.first_holder + tile.holders;
  for (std::uint32_t h = tile.first_holder; h < end;) {
    if (found.count == found.bodies.size()) found.bodies.emplace_back();
    TileBody<D>& at = found.bodies[found.count++];
    at.body = holders_[h].body;
    at.first_holder = h;
    at.nodes = 0;
    for (; h < end && holders_[h].body == at.body; ++h) {
      const std::uint64_t nodes = masses_.in_tile(grid, holders_[h]);
      found.held.push_back({nodes});
      at.nodes |= nodes;
    }
    at.holders = h - at.first_holder;
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
void ContactGrid<D>::fetch_particles(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                     const TileBodies<D>& around, std::uint64_t nodes) const {
  for (const TileBody<D>& at : around.all())
    TileParticles<D>::fetch(grid, bodies[static_cast<std::size_t>(at.body)], holders_of(at),
                            at.nodes & nodes);
}

template <int D>
void ContactGrid<D>::place_sides(TileGrid<D>& grid, const TileBodies<D>& around, Part& part,
                                 ContactNode& node) {
  const Index<D> index = Tile<D>::cell_index(node.cell);
  node.sides = 0;
  for (const TileBody<D>& at : around.all()) {
    if (!(at.nodes >> node.cell & 1u)) continue;
    ++node.sides;
    Side<D>& side = part.sides.emplace_back();
    side.body = at.body;
    side.first_further = static_cast<std::uint32_t>(part.further_places.size());
    bool first = true;
    for (const HeldNodes<D>& nodes : around.held_by(at)) {
      if (!(nodes.with_mass >> node.cell & 1u)) continue;
      const std::uint32_t place = nodes.place(index);
      if (std::exchange(first, false))
        side.place = place;
      else
        part.further_places.push_back(place);
    }
    side.further_count = static_cast<std::uint8_t>(part.further_places.size() - side.first_further);
    __builtin_prefetch(grid.record_at(side.place));
  }
}

template <int D>
void ContactGrid<D>::read_sides(TileGrid<D>& grid, const std::vector<Body<D>>& bodies, Part& part,
                                ContactNode& node) {
  node.held = static_cast<std::uint8_t>(grid.walls.held(place_of(grid, node)));
  node.energy = node.force_work = 0.0;
  std::uint64_t who = 0;
  for (Side<D>& side : part.sides_of(node)) {
    const auto b = static_cast<std::size_t>(side.body);
    who = mix(mix(who, b), bodies[b].active());
    side.prescribed = bodies[b].prescribed;
    side.mass = grid.record_at(side.place)[mass_at];
    side.mapped = read(grid, side, velocity_at);
  }
  if (keeps_) part.known_of(node).who = who;
  sort_sides(part.sides_of(node));
}

template <int D>
void ContactGrid<D>::add_nodes(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                               std::size_t tile, TileBodies<D>& around, Part& part) {
  for (std::uint32_t h = 0; h < tiles_[tile].holders; ++h)
    around.held[h].locate(grid, holders_[tiles_[tile].first_holder + h]);
  const std::size_t first = part.nodes.size();
  std::size_t sides = 0, pairs = 0, places = 0;
  for (const HeldNodes<D>& held : around.held)
    places += static_cast<std::size_t>(std::popcount(held.with_mass & around.overlapped));
  for (std::uint64_t left = around.overlapped; left != 0; left &= left - 1) {
    const int cell = std::countr_zero(left);
    std::uint32_t here = 0;
    for (const TileBody<D>& at : around.all()) here += at.nodes >> cell & 1u ? 1u : 0u;
    sides += here;
    pairs += pair_count(here);
    part.bodies_max = std::max(part.bodies_max, static_cast<int>(here));
  }
  const auto nodes = static_cast<std::size_t>(std::popcount(around.overlapped));
  part.overlapped += nodes;
  part.reserve(nodes, sides, pairs, places - sides);
  if (keeps_) part.known_nodes.resize(first + nodes);
  for (std::uint64_t left = around.overlapped; left != 0; left &= left - 1) {
    ContactNode& node = part.nodes.emplace_back();
    node.cell = static_cast<std::uint8_t>(std::countr_zero(left));
    node.tile = static_cast<std::uint32_t>(tile);
    node.first_side = static_cast<std::uint32_t>(part.sides.size());
    node.first_pair = static_cast<std::uint32_t>(part.pairs.size());
    place_sides(grid, around, part, node);
    part.pairs.resize(part.pairs.size() + pair_count(node.sides));
  }
  if (keeps_) part.known.resize(part.pairs.size());
  for (std::size_t n = first; n < part.nodes.size(); ++n)
    read_sides(grid, bodies, part, part.nodes[n]);
}

template <int D>
void ContactGrid<D>::add_travel(std::size_t bodies) {
  travel_.resize(bodies, 0.0);
  fastest_.resize(bodies, 0.0);
  for (std::size_t b = 0; b < bodies; ++b)
    travel_[b] += last_time_step_ * std::sqrt(std::exchange(fastest_[b], 0.0));
}

template <int D>
void ContactGrid<D>::fill_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                const ContactSettings& settings, std::size_t t,
                                TileBodies<D>& around, std::size_t p, std::size_t first) {
  ContactTile<D>& tile = tiles_[t];
  Part& part = parts_[p];
  const std::span<ContactNode> nodes(part.nodes.begin() + static_cast<std::ptrdiff_t>(first),
                                     part.nodes.end());
  std::uint64_t unknown = around.overlapped;
  if (keeps_)
    for (const ContactNode& node : nodes)
      if (recall(bodies, settings, grid.cell_size, tile, part, node))
        unknown &= ~(std::uint64_t{1} << node.cell);
  if (keeps_) fetch_particles(grid, bodies, around, unknown);
  if (unknown != 0)
    for (TileBody<D>& at : around.all())
      at.particles.gather(grid, bodies[static_cast<std::size_t>(at.body)], tile.tile,
                          holders_of(at), at.nodes & unknown);
  for (const ContactNode& node : nodes)
    if (unknown >> node.cell & 1u) {
      find_pairs(grid, bodies, settings, around, part, node);
      if (keeps_) remember_pairs(part, node);
    }
  tile.known = keeps_ ? around.overlapped : 0;
  tile.known_part = static_cast<std::uint32_t>(p);
  tile.first_known = static_cast<std::uint32_t>(first);
}

template <int D>
void ContactGrid<D>::find(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                          const ContactSettings& settings, double time_step, Threads& threads) {
  keeps_ = settings.normal_travel > 0.0;
  masses_.find(grid, threads);
  if (keeps_) add_travel(bodies.size());
  // Few parts, so that their sizes hardly change; enough to share them out evenly.
  constexpr std::size_t least_tiles = 32, per_thread = 8;
  const std::size_t parts = std::clamp(tiles_.size() / least_tiles, std::size_t{1},
                                       per_thread * static_cast<std::size_t>(threads.count()));
  const auto first_tile = [&](std::size_t p) { return p * tiles_.size() / parts; };
  if (parts > parts_.size()) parts_.resize(parts);  // no part goes: it may know of another's tiles
  for (Part& part : parts_) part.start();
  threads.for_each(parts, [&](std::size_t p) {
    Part& part = parts_[p];
    for (std::size_t t = first_tile(p); t < first_tile(p + 1); ++t) {
      TileBodies<D>& around = bodies_around<D>();
      look_around(grid, tiles_[t], around);
      if (around.overlapped == 0) {
        tiles_[t].known = 0;
        continue;
      }
      const std::size_t first = part.nodes.size();
      if (!keeps_) fetch_particles(grid, bodies, around, around.overlapped);
      add_nodes(grid, bodies, t, around, part);
      fill_pairs(grid, bodies, settings, t, around, p, first);
      // A rigid body's mass is spread over all its nodes, so they stay.
      if (!keeps_)
        part.leave_out(first, [&](const ContactNode& node) {
          return part.any_closed(node) ||
                 std::ranges::any_of(part.sides_of(node), [&](const Side<D>& side) {
                   return bodies[static_cast<std::size_t>(side.body)].rigid && !side.prescribed;
                 });
        });
    }
  });
  last_time_step_ = time_step;
  overlapped_ = 0;
  for (const Part& part : parts_) {
    overlapped_ += part.overlapped;
    bodies_max_ = std::max(bodies_max_, part.bodies_max);
    if (keeps_)
      for (const Side<D>& side : part.sides) {
        double& fastest = fastest_[static_cast<std::size_t>(side.body)];
        fastest = std::max(fastest, dot(side.mapped, side.mapped));
      }
  }
  nodes_max_ = std::max(nodes_max_, overlapped_);
  share_rigid_masses(bodies);
}

template void ContactGrid<2>::find(TileGrid<2>&, const std::vector<Body<2>>&,
                                   const ContactSettings&, double, Threads&);
template void ContactGrid<3>::find(TileGrid<3>&, const std::vector<Body<3>>&,
                                   const ContactSettings&, double, Threads&);

}  // namespace mpm
