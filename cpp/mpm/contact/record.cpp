#include "mpm/contact/record.hpp"

#include <algorithm>

#include "mpm/math/exact_sum.hpp"

namespace mpm {
namespace {

// Of a particle's mass, for a node to count as a first contact.
constexpr double least_share = 1e-6;

}  // namespace

template <int D>
ContactSums record_pairs(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                         const StepEnd& end) {
  // Mass of a side's node over that of a particle.
  const auto share = [&](const BodyAtNode<D>& side) {
    return grid.record_at(side.place)[mass_at] /
           bodies[static_cast<std::size_t>(side.body)].mean_mass;
  };
  PairRecords& records = contact.records;
  records.begin_step();
  ExactSum energy, force_work, friction, friction_first;
  const auto add = [&](ContactPart<D>& part, const ContactNode& node) {
    energy.add(node.energy);
    force_work.add(node.force_work);
    for (const ContactPair<D>& pair : part.pairs_of(node)) {
      if (!pair.loaded) continue;
      const BodyAtNode<D>& side_r = part.sides_of(node)[pair.r];
      const BodyAtNode<D>& side_s = part.sides_of(node)[pair.s];
      const std::size_t record =
          records.of(std::min(side_r.body, side_s.body), std::max(side_r.body, side_s.body));
      PairRecord& r = records[record];
      const double sign =
          side_r.body < side_s.body ? 1.0 : -1.0;  // records hold what acts on the first
      // A node that a body has only just reached tells nothing about when and where they met.
      if (r.first_step < 0 || r.first_step == end.step) {
        const double lighter = std::min(share(side_r), share(side_s));
        if (lighter > std::max(least_share, r.first_share)) {
          r.first_step = end.step;
          r.first_time = end.time;
          r.first_gap = pair.gap;
          r.first_share = lighter;
          const Vec<double, D> x = grid.position_of(place_of(contact, grid, node));
          for (int a = 0; a < D; ++a) {
            r.first_normal[a] = sign * pair.normal[a];
            r.first_node[a] = x[a];
          }
        }
      }
      const Vec<double, D> impulse = pair.impulse();
      double on_first[3] = {};
      for (int a = 0; a < D; ++a) on_first[a] = sign * impulse[a];
      records.add(record, on_first, pair.friction_work);
      friction.add(pair.friction_work);
      friction_first.add(pair.friction_first);
    }
  };
  for (ContactPart<D>& part : contact.parts)
    for (const ContactNode& node : part.nodes) add(part, node);
  records.end_step(end.time_step);
  return {friction.value(), friction_first.value(), energy.value(), force_work.value()};
}

template ContactSums record_pairs<2>(Contact<2>&, TileGrid<2>&, const std::vector<Body<2>>&,
                                     const StepEnd&);
template ContactSums record_pairs<3>(Contact<3>&, TileGrid<3>&, const std::vector<Body<3>>&,
                                     const StepEnd&);

}  // namespace mpm
