#include "mpm/contact/pair_cache.hpp"

#include <bit>
#include <cmath>
#include <utility>

#include "mpm/contact/contact.hpp"
#include "mpm/contact/find_pairs.hpp"

namespace mpm {
namespace {

/// f(pair, cached, sign) for the pairs at a node and their entries among those of the node, which
/// come by the numbers of the bodies: `sign` is that of the normal.
template <int D, class Cached, class F>
void for_each_cached(ContactPart<D>& part, const ContactNode& node, Cached* cached, F&& f) {
  const auto sides = part.sides_of(node);
  // Sides are ordered by mass, which changes from step to step; numbers of bodies do not. Pairs of
  // n sides in rows, r < s: row r begins behind n - 1, n - 2, ... entries, that is at r (2 n - r -
  // 1) / 2.
  const auto rank = [&](std::uint16_t k) {
    return std::ranges::count_if(sides,
                                 [&](const BodyAtNode<D>& x) { return x.body < sides[k].body; });
  };
  for (ContactPair<D>& pair : part.pairs_of(node)) {
    const auto r = rank(pair.r), s = rank(pair.s);
    const auto low = std::min(r, s), high = std::max(r, s);
    f(pair, cached[low * (2 * node.sides - low - 1) / 2 + high - low - 1], r < s ? 1.0 : -1.0);
  }
}

}  // namespace

template <int D>
void invalidate_pairs(Contact<D>& contact) {
  // Without bits nobody looks at what the parts still hold.
  for (ContactTile<D>& tile : contact.tiles) tile.cached = 0;
}

void add_displacements(PairCache& cache, std::size_t bodies) {
  cache.displacement.resize(bodies, 0.0);
  cache.fastest.resize(bodies, 0.0);
  for (const int body : cache.moving) {
    const auto b = static_cast<std::size_t>(body);
    // Sums of the fastest node's way, an upper bound for every other node of the body; of bodies
    // and not of nodes or tiles, so that mirrored bodies find their planes in the same steps
    // (decision 0012).
    cache.displacement[b] += cache.last_time_step * std::sqrt(std::exchange(cache.fastest[b], 0.0));
  }
  cache.moving.clear();
}

template <int D>
void note_speeds(Contact<D>& contact, double time_step, Comm& comm) {
  PairCache& cache = contact.cache;
  cache.last_time_step = time_step;
  if (!cache.on) return;
  for (const ContactPart<D>& part : contact.parts)
    for (const BodyAtNode<D>& side : part.sides) {
      double& fastest = cache.fastest[static_cast<std::size_t>(side.body)];
      // Squares, so that one root a body and step is enough.
      const double square = dot(side.mapped, side.mapped);
      // The first speed of a body in this step lists it; the maximum does not depend on the order.
      if (fastest == 0.0 && square > 0.0) cache.moving.push_back(side.body);
      fastest = std::max(fastest, square);
    }
  if (comm.alone()) return;
  comm.all_max(cache.fastest);
  cache.moving.clear();
  for (std::size_t b = 0; b < cache.fastest.size(); ++b)
    if (cache.fastest[b] > 0.0) cache.moving.push_back(static_cast<int>(b));
}

template <int D>
void store_pairs(const PairCache& cache, ContactPart<D>& part, const ContactNode& node) {
  for_each_cached(part, node, &part.cached[node.first_pair],
                  [&](const ContactPair<D>& pair, CachedPair<D>& cached, double sign) {
                    const double moved = cache.displacement_of<D>(part.sides_of(node), pair);
                    // The way so far, not the way since: it is compared with what it will be then.
                    cached = {sign * pair.normal, pair.gap, moved};
                  });
}

template <int D>
bool reuse_pairs(Contact<D>& contact, const std::vector<Body<D>>& bodies,
                 const ContactSettings& settings, double cell_size, const ContactTile<D>& tile,
                 ContactPart<D>& part, const ContactNode& node) {
  CachedNode& now = part.cached_of(node);
  now.first_pair = node.first_pair;
  now.solved = false;
  const std::uint64_t bit = std::uint64_t{1} << node.cell;
  if (!(tile.cached & bit)) return false;
  const ContactPart<D>& before = contact.parts[tile.cached_part];
  const auto place = static_cast<std::uint32_t>(std::popcount(tile.cached & (bit - 1)));
  // The nodes of a tile were stored in the order of their bits: the rank of a bit is the place.
  const CachedNode& last = before.last_cached_nodes[tile.first_cached + place];
  const std::size_t end = last.first_pair + std::size_t{pair_count(node.sides)};
  // Other bodies, or others' particles, make other pairs. The second test is for a hash that agrees
  // by chance, or a restored state.
  if (last.membership_hash != now.membership_hash || end > before.last_cached.size()) return false;
  const auto sides = part.sides_of(node);
  ContactPair<D>* next = &part.pairs[node.first_pair];
  for (std::uint16_t r = 0; r < node.sides; ++r)
    for (std::uint16_t s = static_cast<std::uint16_t>(r + 1); s < node.sides; ++s)
      *next++ = new_pair<D>(bodies, settings, sides, r, s);
  // Copied even if one of them no longer holds: then find_pairs() and store_pairs() write over all.
  std::copy_n(&before.last_cached[last.first_pair], pair_count(node.sides),
              &part.cached[node.first_pair]);
  bool holds = true;
  for_each_cached(part, node, &part.cached[node.first_pair],
                  [&](ContactPair<D>& pair, CachedPair<D>& cached, double sign) {
                    if (pair.bonded) return;
                    pair.normal = sign * cached.normal;
                    // Without contact the velocities of now are those with which the last step
                    // ended.
                    const Vec<double, D> parting = sides[pair.s].mapped - sides[pair.r].mapped;
                    if (!last.solved)
                      cached.gap += contact.cache.last_time_step * dot(parting, pair.normal);
                    pair.gap = cached.gap;
                    pair.gap_closed = passes_gap_test(pair, settings, cell_size);
                    holds = holds && contact.cache.template displacement_of<D>(sides, pair) -
                                             cached.displacement <=
                                         settings.normal_refresh_distance * cell_size;
                  });
  return holds;
}

template <int D>
void move_gaps(ContactPart<D>& part, const ContactNode& node, const NodeSolution<D>& solution,
               double time_step) {
  // Next step reuse_pairs() must not move these gaps a second time.
  part.cached_of(node).solved = true;
  for_each_cached(part, node, &part.cached[node.first_pair],
                  [&](const ContactPair<D>& pair, CachedPair<D>& cached, double) {
                    const Vec<double, D> parting = solution.sides[pair.s].end_velocity() -
                                                   solution.sides[pair.r].end_velocity();
                    // First order: the normal stays, and the gap opens by (v_s - v_r) . n, with the
                    // velocities that move the particles, eq. (16).
                    cached.gap += time_step * dot(parting, pair.normal);
                  });
}

template void invalidate_pairs<2>(Contact<2>&);
template void invalidate_pairs<3>(Contact<3>&);
template void note_speeds<2>(Contact<2>&, double, Comm&);
template void note_speeds<3>(Contact<3>&, double, Comm&);
template bool reuse_pairs<2>(Contact<2>&, const std::vector<Body<2>>&, const ContactSettings&,
                             double, const ContactTile<2>&, ContactPart<2>&, const ContactNode&);
template bool reuse_pairs<3>(Contact<3>&, const std::vector<Body<3>>&, const ContactSettings&,
                             double, const ContactTile<3>&, ContactPart<3>&, const ContactNode&);
template void store_pairs<2>(const PairCache&, ContactPart<2>&, const ContactNode&);
template void store_pairs<3>(const PairCache&, ContactPart<3>&, const ContactNode&);
template void move_gaps<2>(ContactPart<2>&, const ContactNode&, const NodeSolution<2>&, double);
template void move_gaps<3>(ContactPart<3>&, const ContactNode&, const NodeSolution<3>&, double);

}  // namespace mpm
