#include "mpm/contact/record.hpp"

#include <algorithm>

#include "mpm/comm/all_sums.hpp"

namespace mpm {
namespace {

/// The share of a pair, a < b, among those of a part: nodes beside each other have the same pairs.
template <int D>
PairShare& share_of(ContactPart<D>& part, const PairRecords& records, int a, int b,
                    std::int64_t step) {
  // A short look back in place of a map: a pair that is not found gets a second share, and shares
  // of one pair are added all the same.
  constexpr std::size_t near = 8;
  auto& shares = part.shares;
  for (std::size_t k = shares.size(); k > 0 && k + near > shares.size(); --k)
    if (shares[k - 1].a == a && shares[k - 1].b == b) return shares[k - 1];
  return shares.emplace_back(PairShare{a, b, records.known(a, b, step)});
}

/// What the contacts at the nodes of a part come to.
template <int D>
void sum_part(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
              ContactPart<D>& part, const StepEnd& end) {
  // Mass of a side's node over that of a particle.
  const auto mass_share = [&](const BodyAtNode<D>& side) {
    return grid.nodes.record_at(side.place)[mass_at] /
           bodies[static_cast<std::size_t>(side.body)].mean_mass;
  };
  part.shares.clear();
  part.energy = part.force_work = part.friction = part.friction_first = part.stored = {};
  for (const ContactNode& node : part.nodes) {
    part.energy.add(node.energy);
    part.force_work.add(node.force_work);
    part.stored.add(node.stored);
    for (const ContactPair<D>& pair : part.pairs_of(node)) {
      if (!pair.loaded) continue;
      const BodyAtNode<D>& r = part.sides_of(node)[pair.r];
      const BodyAtNode<D>& s = part.sides_of(node)[pair.s];
      const double sign = r.body < s.body ? 1.0 : -1.0;  // records hold what acts on the first
      PairShare& share = share_of(part, contact.records, std::min(r.body, s.body),
                                  std::max(r.body, s.body), end.step);
      const Vec<double, D> impulse = pair.impulse();
      double on_first[3] = {};
      for (int a = 0; a < D; ++a) on_first[a] = sign * impulse[a];
      contact.records.add_to(share, on_first, pair.friction_work);
      part.friction.add(pair.friction_work);
      part.friction_first.add(pair.friction_first);
      // They have met before this step: where and how they first did is known.
      if (share.known) continue;
      const double lighter = std::min(mass_share(r), mass_share(s));
      if (lighter < share.share) continue;
      const Vec<double, D> x = grid.position_of(place_of(contact, grid, node));
      const Vector3 place = in_space<D>(x);
      // The node that tells of the first contact is the one where the lighter body has most mass.
      if (lighter == share.share && !is_lower(place.c, share.node)) continue;
      share.share = lighter;
      share.gap = pair.gap;
      for (int a = 0; a < D; ++a) {
        share.normal[a] = sign * pair.normal[a];
        share.node[a] = x[a];
      }
    }
  }
}

}  // namespace

template <int D>
ContactSums record_pairs(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                         const StepEnd& end, Threads& threads) {
  PairRecords& records = contact.records;
  if (!contact.leaves_surfaces) records.begin_step();  // else what surfaces pass on is in it
  threads.for_each(contact.parts.size(),
                   [&](std::size_t p) { sum_part(contact, grid, bodies, contact.parts[p], end); });
  std::array<ExactSum, 5> sums;
  for (const ContactPart<D>& part : contact.parts) {
    sums[0].add(part.friction);
    sums[1].add(part.friction_first);
    sums[2].add(part.energy);
    sums[3].add(part.force_work);
    sums[4].add(part.stored);
    for (const PairShare& share : part.shares) records.add(share, end.step, end.time);
  }
  all_sum(*grid.partition.comm, sums);
  records.end_step(end.time_step);
  return {sums[0].value(), sums[1].value(), sums[2].value(), sums[3].value(), sums[4].value()};
}

template ContactSums record_pairs<2>(Contact<2>&, TileGrid<2>&, const std::vector<Body<2>>&,
                                     const StepEnd&, Threads&);
template ContactSums record_pairs<3>(Contact<3>&, TileGrid<3>&, const std::vector<Body<3>>&,
                                     const StepEnd&, Threads&);

}  // namespace mpm
