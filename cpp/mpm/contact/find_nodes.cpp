// The overlapped nodes of a step: who has mass there.
#include "mpm/contact/find_nodes.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "mpm/contact/exchange_contact.hpp"
#include "mpm/contact/find_pairs.hpp"
#include "mpm/contact/find_springs.hpp"
#include "mpm/contact/find_touches.hpp"
#include "mpm/contact/rigid_masses.hpp"

namespace mpm {
namespace {

/// A hash that goes on with another number (Knuth 1973, section 6.4).
std::uint64_t mix(std::uint64_t hash, std::uint64_t x) {
  hash = (hash ^ x) * 0x9E3779B97F4A7C15u;
  return hash ^ hash >> 32;
}

template <int D>
TileBodies<D>& bodies_around() {
  // Of a thread, not of a part: it keeps its memory from tile to tile.
  thread_local TileBodies<D> around;
  return around;
}

/// Have the memory bring the particles around nodes of a tile, a bit each by Tile<D>::cell.
template <int D>
void fetch_particles(const Contact<D>& contact, const TileGrid<D>& grid,
                     const std::vector<Body<D>>& bodies, const std::vector<ParticlePool<D>>& pools,
                     const TileBodies<D>& around, std::uint64_t nodes) {
  for (const TileBody<D>& at : around.all()) {
    TileParticles<D>::fetch(grid, pools[pool_number(bodies, at.body)], at.of(contact.holders),
                            at.nodes & nodes);
  }
}

/// Where the sides of a node are, their masses and velocities left to be read.
template <int D>
void place_sides(TileGrid<D>& grid, const TileBodies<D>& around, ContactPart<D>& part,
                 ContactNode& node) {
  const Index<D> index = Tile<D>::cell_index(node.cell);
  node.sides = 0;
  for (const TileBody<D>& at : around.all()) {
    if (!(at.nodes >> node.cell & 1u)) continue;
    ++node.sides;
    BodyAtNode<D>& side = part.sides.emplace_back();
    side.body = at.body;
    side.first_further = static_cast<std::uint32_t>(part.further_places.size());
    bool first = true;
    // The places are searched once, here; three stages then go straight to the records (decision
    // 0027).
    for (const HeldNodes<D>& nodes : around.held_by(at)) {
      if (!(nodes.with_mass >> node.cell & 1u)) continue;
      const std::uint32_t place = nodes.place(index);
      if (std::exchange(first, false))
        side.place = place;
      else
        part.further_places.push_back(place);
    }
    side.further_count = static_cast<std::uint8_t>(part.further_places.size() - side.first_further);
    // read_sides() comes to it when all nodes of the tile have been placed.
    __builtin_prefetch(grid.nodes.record_at(side.place));
  }
}

template <int D>
void read_sides(const Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                ContactPart<D>& part, ContactNode& node) {
  node.constrained_axes =
      static_cast<std::uint8_t>(grid.walls.constrained_axes(place_of(contact, grid, node)));
  // Nodes that the response passes by are still summed for the ledger.
  node.energy = node.force_work = node.stored = 0.0;
  std::uint64_t hash = 0;
  for (BodyAtNode<D>& side : part.sides_of(node)) {
    const auto b = static_cast<std::size_t>(side.body);
    // Before the sides are sorted: by their bodies' numbers, as pairs are cached, else a change of
    // masses would look like a change of bodies. With the number of active particles, for erosion
    // moves a surface without any motion.
    hash = mix(mix(hash, b), bodies[b].active());
    side.prescribed = bodies[b].is_prescribed();
    // Of the first copy: all hold the sum over the patches.
    side.mass = grid.nodes.record_at(side.place)[mass_at];
    side.mapped = read(grid, side, velocity_at);
  }
  if (contact.cache.on) part.cached_of(node).membership_hash = hash;
  sort_sides(part.sides_of(node));
}

/// The overlapped nodes of a tile, their sides read and their pairs empty.
template <int D>
void add_nodes(const Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
               std::size_t tile, TileBodies<D>& around, ContactPart<D>& part) {
  for (std::uint32_t h = 0; h < contact.tiles[tile].holders; ++h)
    around.held[h].locate(grid, contact.holders[contact.tiles[tile].first_holder + h]);
  const std::size_t first = part.nodes.size();
  // Counted first, so that each array grows once for a tile, and references into it hold.
  std::size_t sides = 0, pairs = 0, places = 0;
  for (const HeldNodes<D>& held : around.held)
    places += static_cast<std::size_t>(std::popcount(held.with_mass & around.overlapped));
  for (std::uint64_t left = around.overlapped; left != 0; left &= left - 1) {
    const int cell = std::countr_zero(left);
    std::uint32_t here = 0;
    for (const TileBody<D>& at : around.all()) here += at.nodes >> cell & 1u ? 1u : 0u;
    sides += here;
    pairs += pair_count(here);
  }
  const auto nodes = static_cast<std::size_t>(std::popcount(around.overlapped));
  part.reserve(nodes, sides, pairs, places - sides);
  if (contact.cache.on) part.cached_nodes.resize(first + nodes);
  for (std::uint64_t left = around.overlapped; left != 0; left &= left - 1) {
    ContactNode& node = part.nodes.emplace_back();
    node.cell = static_cast<std::uint8_t>(std::countr_zero(left));
    node.tile = static_cast<std::uint32_t>(tile);
    // Numbers in place of pointers: the arrays may still move while further tiles are added.
    node.first_side = static_cast<std::uint32_t>(part.sides.size());
    node.first_pair = static_cast<std::uint32_t>(part.pairs.size());
    place_sides(grid, around, part, node);
    part.pairs.resize(part.pairs.size() + pair_count(node.sides));
  }
  if (contact.cache.on) part.cached.resize(part.pairs.size());
  for (std::size_t n = first; n < part.nodes.size(); ++n)
    read_sides(contact, grid, bodies, part, part.nodes[n]);
}

/// Normals, gaps and frictions of the pairs at the nodes of a tile, those of a part from the
/// first-th on: cached ones that still hold, else found.
template <int D>
void fill_pairs(Contact<D>& contact, const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                const std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                std::size_t t, TileBodies<D>& around, std::size_t p, std::size_t first) {
  ContactTile<D>& tile = contact.tiles[t];
  ContactPart<D>& part = contact.parts[p];
  const std::span<ContactNode> nodes(part.nodes.begin() + static_cast<std::ptrdiff_t>(first),
                                     part.nodes.end());
  // Particles are gathered only around nodes where nothing is cached: most of what contact costs.
  std::uint64_t missing = around.overlapped;
  if (contact.cache.on)
    for (const ContactNode& node : nodes)
      if (reuse_pairs(contact, bodies, settings, grid.cell_size, tile, part, node))
        missing &= ~(std::uint64_t{1} << node.cell);
  if (contact.cache.on) fetch_particles(contact, grid, bodies, pools, around, missing);
  if (missing != 0)
    for (TileBody<D>& at : around.all()) {
      const Body<D>& body = bodies[static_cast<std::size_t>(at.body)];
      at.particles.gather(grid, body, pools[static_cast<std::size_t>(body.material)], tile.tile,
                          at.of(contact.holders), at.nodes & missing);
    }
  for (const ContactNode& node : nodes)
    if (missing >> node.cell & 1u) {
      find_pairs<D>(grid, bodies, settings, around, part, node);
      if (contact.cache.on) store_pairs(contact.cache, part, node);
    }
  // Where nodes are kept none is left out, so that those of the bits are there one by one.
  tile.cached = contact.cache.on ? around.overlapped : 0;
  tile.cached_part = static_cast<std::uint32_t>(p);
  tile.first_cached = static_cast<std::uint32_t>(first);
}

/// Where shape functions end at the latest along an axis [cells]: GIMP's grow with the particles at
/// the start.
template <int D>
double widest_support(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies) {
  double widest = 0.0;
  for (const Body<D>& body : bodies)
    widest = std::max(widest, support(grid.basis, body.mean_edge / grid.cell_size));
  return widest;
}

/// The pairs at the nodes of a tile, those of a part from the first-th on, by their springs; if
/// they are `made` only of those that springs part.
template <int D>
void fill_springs(const Contact<D>& contact, const TileGrid<D>& grid,
                  const std::vector<Body<D>>& bodies, const ContactSettings& settings,
                  const TileTouches<D>& touches, ContactPart<D>& part, std::size_t first,
                  bool made) {
  for (std::size_t n = first; n < part.nodes.size(); ++n)
    find_springs<D>(grid, bodies, settings, touches, part, part.nodes[n],
                    place_of(contact, grid, part.nodes[n]), made);
}

/// Is the approach of any two bodies around a tile stopped, where springs part others?
template <int D>
bool stops_any(const std::vector<Body<D>>& bodies, const ContactSettings& settings,
               const TileBodies<D>& around) {
  if (settings.response == Response::springs) return false;  // whatever the pair
  const std::span<const TileBody<D>> all = around.all();
  const auto matter = [&](const TileBody<D>& at) {
    return bodies[static_cast<std::size_t>(at.body)].matter;
  };
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b)
      if (stops_approach(settings.response, matter(all[a]), matter(all[b]))) return true;
  return false;
}

/// How many nodes are overlapped, and by how many bodies at most, on all ranks.
template <int D>
void count_nodes(Contact<D>& contact, Comm& comm) {
  // Integers and maxima: no order of the parts is seen.
  contact.counts.overlapped = 0;
  for (const ContactPart<D>& part : contact.parts) {
    contact.counts.overlapped += part.overlapped;
    contact.counts.bodies_max = std::max(contact.counts.bodies_max, part.bodies_max);
  }
  contact.counts.overlapped =
      static_cast<std::size_t>(all_sum(comm, static_cast<std::int64_t>(contact.counts.overlapped)));
  contact.counts.bodies_max = static_cast<int>(all_max(comm, contact.counts.bodies_max));
  contact.counts.overlapped_max =
      std::max(contact.counts.overlapped_max, contact.counts.overlapped);
}

}  // namespace

template <int D>
void find_nodes(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                const std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                double time_step, Threads& threads) {
  contact.cache.on = settings.normal_refresh_distance > 0.0;
  // The bits hold for this step only: masses have just been mapped.
  contact.masses.find(grid, threads);
  if (contact.cache.on) add_displacements(contact.cache, bodies.size());
  const bool springs = may_spring(settings.response), bonded = bonds(settings);
  const double widest = springs ? widest_support(grid, bodies) : 0.0;
  if (springs) {
    find_touches(contact, grid, bodies, pools, settings, threads);
    exchange_touches(contact, grid, widest);
  }
  const TileShares shares(contact.tiles.size(), threads.count());
  if (shares.count > contact.parts.size())
    contact.parts.resize(shares.count);  // no part goes: it may know of another's tiles
  for (ContactPart<D>& part : contact.parts) part.start();
  threads.for_each(shares.count, [&](std::size_t p) {
    ContactPart<D>& part = contact.parts[p];
    for (std::size_t t = shares.first(p); t < shares.first(p + 1); ++t) {
      TileBodies<D>& around = bodies_around<D>();
      look_around(contact, grid, contact.tiles[t], around);
      count_overlapped(around, part);
      const bool stops = !springs || stops_any(bodies, settings, around);
      if (springs) {
        around.touches.gather(contact, t, widest);
        // A rigid body's mass is spread over all nodes where it meets others, and bonds need no
        // touch.
        if (!contact.has_free_rigid && !bonded && !stops)
          around.overlapped &= around.touches.nodes();
      }
      contact.tiles[t].node_count = static_cast<std::uint8_t>(std::popcount(around.overlapped));
      if (around.overlapped == 0) {
        contact.tiles[t].cached = 0;
        continue;
      }
      const std::size_t first = part.nodes.size();
      if (!contact.cache.on && stops)
        fetch_particles(contact, grid, bodies, pools, around, around.overlapped);
      add_nodes(contact, grid, bodies, t, around, part);
      if (stops) fill_pairs(contact, grid, bodies, pools, settings, t, around, p, first);
      if (springs)
        fill_springs(contact, grid, bodies, settings, around.touches, part, first, stops);
      // A rigid body's mass is spread over all its nodes, so they stay.
      if (!contact.cache.on)
        part.leave_out(first, [&](const ContactNode& node) {
          return part.any_gap_closed(node) ||
                 std::ranges::any_of(part.sides_of(node), [&](const BodyAtNode<D>& side) {
                   return bodies[static_cast<std::size_t>(side.body)].is_free_rigid();
                 });
        });
    }
  });
  Comm& comm = *grid.partition.comm;
  count_nodes(contact, comm);
  note_speeds(contact, time_step, comm);
  share_rigid_masses(contact, bodies, comm);
}

template void find_nodes<2>(Contact<2>&, TileGrid<2>&, const std::vector<Body<2>>&,
                            const std::vector<ParticlePool<2>>&, const ContactSettings&, double,
                            Threads&);
template void find_nodes<3>(Contact<3>&, TileGrid<3>&, const std::vector<Body<3>>&,
                            const std::vector<ParticlePool<3>>&, const ContactSettings&, double,
                            Threads&);

}  // namespace mpm
