// The overlapped nodes of a step: who has mass there.
#include <algorithm>
#include <bit>

#include "mpm/contact/contact_grid.hpp"

namespace mpm {
namespace {

/// Room for more than is needed now, so that numbers which creep up seldom allocate.
template <class T>
void resize(std::vector<T>& v, std::size_t size) {
  if (size > v.capacity()) v.reserve(size + size / 8);
  v.resize(size);
}

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
  found.planes.forget();
  std::uint64_t once = 0;
  found.overlapped = 0;
  const std::uint32_t end = tile.first_holder + tile.holders;
  for (std::uint32_t h = tile.first_holder; h < end;) {
    if (found.count == found.bodies.size()) found.bodies.emplace_back();
    TileBody<D>& at = found.bodies[found.count++];
    at.body = holders_[h].body;
    at.first_holder = h;
    at.nodes = 0;
    for (; h < end && holders_[h].body == at.body; ++h)
      at.nodes |= masses_.in_tile(grid, holders_[h]);
    at.holders = h - at.first_holder;
    found.overlapped |= once & at.nodes;
    once |= at.nodes;
  }
  if (!grid.walls.exist) return;
  for (std::uint64_t left = found.overlapped; left != 0; left &= left - 1) {
    const int cell = std::countr_zero(left);
    Index<D> node = Tile<D>::cell_index(cell), image;
    for (std::size_t a = 0; a < D; ++a) node[a] += grid.first_cell(tile.tile)[a];
    // A node beyond a slip wall follows its image.
    if (grid.walls.mirrored(node, image)) found.overlapped &= ~(std::uint64_t{1} << cell);
  }
}

template <int D>
void ContactGrid<D>::place_sides(TileGrid<D>& grid, const TileBodies<D>& around,
                                 ContactNode& node) {
  const Index<D> index = Tile<D>::cell_index(node.cell);
  node.sides = 0;
  for (const TileBody<D>& at : around.all()) {
    if (!(at.nodes >> node.cell & 1u)) continue;
    Side<D>& side = sides_[node.first_side + node.sides++];
    side.body = at.body;
    side.copies = 0;
    for (std::uint32_t h = at.first_holder; h < at.first_holder + at.holders; ++h)
      if (holds_node<D>(grid, holders_[h], index) && side.copies++ == 0) side.first_copy = h;
    side.node =
        static_cast<std::uint16_t>(node_in_holder<D>(grid, holders_[side.first_copy], index));
    const NodeBlock<D> block = grid.block(patch_of(side));
    __builtin_prefetch(block.mass() + side.node);
    for (int a = 0; a < D; ++a) __builtin_prefetch(block.velocity(a) + side.node);
  }
}

template <int D>
void ContactGrid<D>::read_sides(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                ContactNode& node) {
  node.held = static_cast<std::uint8_t>(grid.walls.held(place_of(grid, node)));
  node.energy = node.force_work = 0.0;
  std::uint64_t who = 0;
  for (Side<D>& side : sides_of(node)) {
    const auto b = static_cast<std::size_t>(side.body);
    who = mix(mix(who, b), bodies[b].active());
    side.prescribed = bodies[b].prescribed;
    side.mass = grid.block(patch_of(side)).mass()[side.node];
    side.mapped =
        read(grid, side, [](const NodeBlock<D>& block, int a) { return block.velocity(a); });
  }
  if (keeps_) known_nodes_[number_of(node)].who = who;
  sort_sides(sides_of(node));
}

template <int D>
void ContactGrid<D>::count(const TileGrid<D>& grid, Threads& threads) {
  counts_.assign(tiles_.size() + 1, {});
  threads.for_each(tiles_.size(), [&](std::size_t t) {
    TileBodies<D>& around = bodies_around<D>();
    look_around(grid, tiles_[t], around);
    TileCounts c{};
    for (std::uint64_t left = around.overlapped; left != 0; left &= left - 1) {
      const int cell = std::countr_zero(left);
      std::uint32_t sides = 0;
      for (const TileBody<D>& at : around.all()) sides += at.nodes >> cell & 1u ? 1u : 0u;
      ++c.nodes;
      c.sides += sides;
      c.pairs += pair_count(sides);
    }
    counts_[t + 1] = c;
  });
  for (std::size_t t = 1; t < counts_.size(); ++t) {
    counts_[t].nodes += counts_[t - 1].nodes;
    counts_[t].sides += counts_[t - 1].sides;
    counts_[t].pairs += counts_[t - 1].pairs;
  }
  std::swap(known_, last_known_);
  std::swap(known_nodes_, last_known_nodes_);
  resize(nodes_, counts_.back().nodes);
  resize(sides_, counts_.back().sides);
  resize(pairs_, counts_.back().pairs);
  resize(known_nodes_, keeps_ ? counts_.back().nodes : 0);
  resize(known_, keeps_ ? counts_.back().pairs : 0);
  nodes_max_ = std::max(nodes_max_, nodes_.size());
}

template <int D>
void ContactGrid<D>::add_travel(std::size_t bodies) {
  travel_.resize(bodies, 0.0);
  fastest_.assign(bodies, 0.0);
  for (const Side<D>& side : sides_) {
    double& fastest = fastest_[static_cast<std::size_t>(side.body)];
    fastest = std::max(fastest, dot(side.mapped, side.mapped));
  }
  for (std::size_t b = 0; b < bodies; ++b) travel_[b] += last_time_step_ * std::sqrt(fastest_[b]);
}

template <int D>
void ContactGrid<D>::fill_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                const std::vector<double>& stiffness,
                                const ContactSettings& settings, std::size_t t) {
  ContactTile<D>& tile = tiles_[t];
  const std::span<ContactNode> nodes(nodes_.data() + counts_[t].nodes,
                                     counts_[t + 1].nodes - counts_[t].nodes);
  std::uint64_t overlapped = 0, unknown = 0;
  for (const ContactNode& node : nodes) {
    const std::uint64_t bit = std::uint64_t{1} << node.cell;
    overlapped |= bit;
    unknown |= bit;
    if (!keeps_) continue;
    KnownNode& now = known_nodes_[number_of(node)];
    now.first_pair = node.first_pair;
    now.solved = false;
    if (tile.known & bit) {
      const int before = std::popcount(tile.known & (bit - 1));
      const KnownNode& last =
          last_known_nodes_[tile.first_known + static_cast<std::uint32_t>(before)];
      if (last.who == now.who && recall(bodies, settings, grid.cell_size, last, node))
        unknown &= ~bit;
    }
  }
  if (unknown != 0) {
    TileBodies<D>& around = bodies_around<D>();
    look_around(grid, tile, around);
    for (TileBody<D>& at : around.all())
      at.particles.gather(grid, bodies[static_cast<std::size_t>(at.body)], tile.tile,
                          {&holders_[at.first_holder], at.holders}, at.nodes & unknown);
    for (const ContactNode& node : nodes)
      if (unknown >> node.cell & 1u) {
        find_pairs(grid, bodies, stiffness, settings, around, node);
        if (keeps_) remember_pairs(node);
      }
  }
  tile.known = keeps_ ? overlapped : 0;
  tile.first_known = counts_[t].nodes;
}

template <int D>
void ContactGrid<D>::find(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                          const std::vector<double>& stiffness, const ContactSettings& settings,
                          double time_step, Threads& threads) {
  keeps_ = settings.normal_travel > 0.0;
  masses_.find(grid, threads);
  count(grid, threads);
  threads.for_each(tiles_.size(), [&](std::size_t t) {
    TileCounts c = counts_[t];
    if (c.nodes == counts_[t + 1].nodes) return;
    TileBodies<D>& around = bodies_around<D>();
    look_around(grid, tiles_[t], around);
    for (std::uint64_t left = around.overlapped; left != 0; left &= left - 1) {
      ContactNode& node = nodes_[c.nodes++];
      node.cell = static_cast<std::uint8_t>(std::countr_zero(left));
      node.tile = static_cast<std::uint32_t>(t);
      node.first_side = c.sides;
      node.first_pair = c.pairs;
      place_sides(grid, around, node);
      c.sides += node.sides;
      c.pairs += pair_count(node.sides);
    }
    for (std::uint32_t n = counts_[t].nodes; n < c.nodes; ++n) read_sides(grid, bodies, nodes_[n]);
  });
  if (keeps_) add_travel(bodies.size());
  threads.for_each(tiles_.size(),
                   [&](std::size_t t) { fill_pairs(grid, bodies, stiffness, settings, t); });
  last_time_step_ = time_step;
  share_rigid_masses(bodies);
  for (const ContactNode& node : nodes_)
    bodies_max_ = std::max(bodies_max_, static_cast<int>(node.sides));
}

template void ContactGrid<2>::find(TileGrid<2>&, const std::vector<Body<2>>&,
                                   const std::vector<double>&, const ContactSettings&, double,
                                   Threads&);
template void ContactGrid<3>::find(TileGrid<3>&, const std::vector<Body<3>>&,
                                   const std::vector<double>&, const ContactSettings&, double,
                                   Threads&);

}  // namespace mpm
