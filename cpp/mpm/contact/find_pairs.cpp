// The pairs of bodies at a node: normals, gaps, eq. (5), and frictions.
#include <bit>
#include <vector>

#include "mpm/contact/contact_grid.hpp"
#include "mpm/contact/normal.hpp"

namespace mpm {
namespace {

// Gaps along the line between the centres wider than this are left as they are (decision 0008).
constexpr double surely_open = 0.5;  // [cells]

/// D_rs = D_r + D_s of eq. (5) [m], each D the distance from the node to the body's surface along
/// the unit vector; infinite for a zero vector.
template <int D>
double gap_along(const Vec<double, D>& normal, const NormalSource<D>& r, const NormalSource<D>& s,
                 double cell_size) {
  if (!(dot(normal, normal) > 0.0)) return std::numeric_limits<double>::infinity();
  return -cell_size * (r.particles.extent_along(normal) + s.particles.extent_along(-1.0 * normal));
}

/// The unit vector from the centre of r's particles around the node to that of s's; zero if they
/// are one.
template <int D>
Vec<double, D> between_centres(const NearParticles<D>& r, const NearParticles<D>& s,
                               unsigned held) {
  Vec<double, D> n = s.centre() - r.centre();
  for (int a = 0; a < D; ++a)
    if (held >> a & 1u) n[a] = 0.0;
  return normalised(n, 1e-9);
}

/// Does a pair pass the test of the gap, eq. (5), if that is asked for? Bodies that just touch do,
/// as they are often put into a case: rounding must not choose.
template <int D>
bool may_act(const SidePair<D>& pair, const ContactSettings& settings, double cell_size) {
  constexpr double rounding = 1e-9;  // [cells]; positions are good to 1e-10 at 2^19 cells
  return dot(pair.normal, pair.normal) > 0.0 &&
         (settings.detection == Detection::velocity ||
          pair.gap < settings.gap_distance + rounding * cell_size);
}

}  // namespace

template <int D>
void ContactGrid<D>::start_pair(const std::vector<Body<D>>& bodies, const ContactSettings& settings,
                                std::span<const Side<D>> sides, std::uint16_t r, std::uint16_t s,
                                SidePair<D>& pair) const {
  pair = {};
  pair.r = r;
  pair.s = s;
  pair.friction = friction(settings, bodies[static_cast<std::size_t>(sides[r].body)].group,
                           bodies[static_cast<std::size_t>(sides[s].body)].group);
}

template <int D>
template <class Known, class F>
void ContactGrid<D>::for_each_known(Part& part, const ContactNode& node, Known* known, F&& f) {
  const auto sides = part.sides_of(node);
  const auto rank = [&](std::uint16_t k) {
    return std::ranges::count_if(sides, [&](const Side<D>& x) { return x.body < sides[k].body; });
  };
  for (SidePair<D>& pair : part.pairs_of(node)) {
    const auto r = rank(pair.r), s = rank(pair.s);
    const auto low = std::min(r, s), high = std::max(r, s);
    f(pair, known[low * (2 * node.sides - low - 1) / 2 + high - low - 1], r < s ? 1.0 : -1.0);
  }
}

template <int D>
void ContactGrid<D>::find_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                const ContactSettings& settings, TileBodies<D>& around, Part& part,
                                const ContactNode& node) {
  const auto sides = part.sides_of(node);
  const auto rigid = [&](std::uint32_t k) {
    return bodies[static_cast<std::size_t>(sides[k].body)].rigid;
  };
  const Index<D> index = Tile<D>::cell_index(node.cell);
  // Scratch of one thread, not counted among the bytes of the contact.
  thread_local std::vector<NormalSource<D>> sources;
  if (sources.size() < node.sides) sources.resize(node.sides);
  for (std::uint32_t k = 0; k < node.sides; ++k) {
    const auto b = static_cast<std::size_t>(sides[k].body);
    NormalSource<D>& source = sources[k];
    source.body = sides[k].body;
    source.stiffness = bodies[b].stiffness;
    Vec<double, D> gradient = Vec<double, D>::zero();
    TileBody<D>& at = around.with(sides[k].body);
    const double edge = bodies[b].mean_edge / grid.cell_size;
    collect_near<D>(at.particles, index, support(grid.basis, edge), source.particles);
    if (settings.normal != NormalRule::plane)
      gradient = mass_gradient<D>(at.particles, index, grid, edge);
    // A wall mirrors the body, so its surface is normal to the wall there.
    for (int a = 0; a < D; ++a)
      if (node.held >> a & 1u) gradient[a] = 0.0;
    source.normal = weighted_normal(gradient, sides[k].mass, grid.cell_size);
  }
  SidePair<D>* next = &part.pairs[node.first_pair];
  for (std::uint16_t r = 0; r < node.sides; ++r)
    for (std::uint16_t s = static_cast<std::uint16_t>(r + 1); s < node.sides; ++s) {
      SidePair<D>& pair = *next++;
      start_pair(bodies, settings, sides, r, s, pair);
      pair.gap = std::numeric_limits<double>::infinity();
      if (rigid(r) && rigid(s)) continue;  // they have no stress that could part them
      // Bodies that are well apart along the line between their centres need no better normal.
      const bool by_gap = settings.detection == Detection::gap;
      if (by_gap && settings.normal == NormalRule::plane) {
        pair.normal = between_centres(sources[r].particles, sources[s].particles, node.held);
        pair.gap = gap_along(pair.normal, sources[r], sources[s], grid.cell_size);
        if (pair.gap > settings.gap_distance + surely_open * grid.cell_size) continue;
      }
      pair.normal = pair_normal(sources[r], sources[s], settings.normal, node.held);
      pair.gap = gap_along(pair.normal, sources[r], sources[s], grid.cell_size);
      pair.closed = may_act(pair, settings, grid.cell_size);
    }
}

template <int D>
double ContactGrid<D>::travel_of(std::span<const Side<D>> sides, const SidePair<D>& pair) const {
  return travel_[static_cast<std::size_t>(sides[pair.r].body)] +
         travel_[static_cast<std::size_t>(sides[pair.s].body)];
}

template <int D>
void ContactGrid<D>::remember_pairs(Part& part, const ContactNode& node) {
  for_each_known(part, node, &part.known[node.first_pair],
                 [&](const SidePair<D>& pair, KnownPair<D>& known, double sign) {
                   const double travel = travel_of(part.sides_of(node), pair);
                   known = {sign * pair.normal, pair.gap, travel};
                 });
}

template <int D>
bool ContactGrid<D>::recall(const std::vector<Body<D>>& bodies, const ContactSettings& settings,
                            double cell_size, const ContactTile<D>& tile, Part& part,
                            const ContactNode& node) {
  KnownNode& now = part.known_of(node);
  now.first_pair = node.first_pair;
  now.solved = false;
  const std::uint64_t bit = std::uint64_t{1} << node.cell;
  if (!(tile.known & bit)) return false;
  const Part& before = parts_[tile.known_part];
  const auto place = static_cast<std::uint32_t>(std::popcount(tile.known & (bit - 1)));
  const KnownNode& last = before.last_known_nodes[tile.first_known + place];
  const std::size_t end = last.first_pair + std::size_t{pair_count(node.sides)};
  if (last.who != now.who || end > before.last_known.size()) return false;
  const auto sides = part.sides_of(node);
  SidePair<D>* next = &part.pairs[node.first_pair];
  for (std::uint16_t r = 0; r < node.sides; ++r)
    for (std::uint16_t s = static_cast<std::uint16_t>(r + 1); s < node.sides; ++s)
      start_pair(bodies, settings, sides, r, s, *next++);
  std::copy_n(&before.last_known[last.first_pair], pair_count(node.sides),
              &part.known[node.first_pair]);
  bool holds = true;
  for_each_known(part, node, &part.known[node.first_pair],
                 [&](SidePair<D>& pair, KnownPair<D>& known, double sign) {
                   pair.normal = sign * known.normal;
                   // Without contact the velocities of now are those with which the last step
                   // ended.
                   const Vec<double, D> parting = sides[pair.s].mapped - sides[pair.r].mapped;
                   if (!last.solved) known.gap += last_time_step_ * dot(parting, pair.normal);
                   pair.gap = known.gap;
                   pair.closed = may_act(pair, settings, cell_size);
                   holds = holds && travel_of(sides, pair) - known.travel <=
                                        settings.normal_travel * cell_size;
                 });
  return holds;
}

template <int D>
void ContactGrid<D>::move_gaps(Part& part, const ContactNode& node, const NodeSolution<D>& solution,
                               double time_step) {
  if (!keeps_) return;
  part.known_of(node).solved = true;
  for_each_known(part, node, &part.known[node.first_pair],
                 [&](const SidePair<D>& pair, KnownPair<D>& known, double) {
                   const Vec<double, D> parting = solution.sides[pair.s].end_velocity() -
                                                  solution.sides[pair.r].end_velocity();
                   known.gap += time_step * dot(parting, pair.normal);
                 });
}

template void ContactGrid<2>::remember_pairs(Part&, const ContactNode&);
template bool ContactGrid<2>::recall(const std::vector<Body<2>>&, const ContactSettings&, double,
                                     const ContactTile<2>&, Part&, const ContactNode&);
template void ContactGrid<2>::move_gaps(Part&, const ContactNode&, const NodeSolution<2>&, double);
template void ContactGrid<2>::find_pairs(const TileGrid<2>&, const std::vector<Body<2>>&,
                                         const ContactSettings&, TileBodies<2>&, Part&,
                                         const ContactNode&);
template void ContactGrid<3>::remember_pairs(Part&, const ContactNode&);
template bool ContactGrid<3>::recall(const std::vector<Body<3>>&, const ContactSettings&, double,
                                     const ContactTile<3>&, Part&, const ContactNode&);
template void ContactGrid<3>::move_gaps(Part&, const ContactNode&, const NodeSolution<3>&, double);
template void ContactGrid<3>::find_pairs(const TileGrid<3>&, const std::vector<Body<3>>&,
                                         const ContactSettings&, TileBodies<3>&, Part&,
                                         const ContactNode&);

}  // namespace mpm
