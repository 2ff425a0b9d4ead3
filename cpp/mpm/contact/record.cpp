#include "mpm/contact/record.hpp"

#include <algorithm>

#include "mpm/math/exact_sum.hpp"

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
      // The node that tells of the first contact is the one where the lighter body has most mass;
      // of equals the first, so a strict comparison in the order of the nodes.
      if (!(lighter > share.share)) continue;
      share.share = lighter;
      share.gap = pair.gap;
      const Vec<double, D> x = grid.position_of(place_of(contact, grid, node));
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
  records.begin_step();
  threads.for_each(contact.parts.size(),
                   [&](std::size_t p) { sum_part(contact, grid, bodies, contact.parts[p], end); });
  ExactSum energy, force_work, friction, friction_first, stored;
  for (const ContactPart<D>& part : contact.parts) {
    energy.add(part.energy);
    force_work.add(part.force_work);
    friction.add(part.friction);
    friction_first.add(part.friction_first);
    stored.add(part.stored);
    // In the order of the parts, though the sums need none (decision 0038): ties between nodes of a
    // first contact do.
    for (const PairShare& share : part.shares) records.add(share, end.step, end.time);
  }
  records.end_step(end.time_step);
  return {friction.value(), friction_first.value(), energy.value(), force_work.value(),
          stored.value()};
}

template ContactSums record_pairs<2>(Contact<2>&, TileGrid<2>&, const std::vector<Body<2>>&,
                                     const StepEnd&, Threads&);
template ContactSums record_pairs<3>(Contact<3>&, TileGrid<3>&, const std::vector<Body<3>>&,
                                     const StepEnd&, Threads&);

}  // namespace mpm
