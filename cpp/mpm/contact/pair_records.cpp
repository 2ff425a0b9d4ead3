#include <algorithm>

#include "mpm/contact/contact_grid.hpp"

namespace mpm {
namespace {

// Of a particle's mass, for a node to count as a first contact.
constexpr double least_share = 1e-6;

/// Spread the pairs of bodies over all numbers (Fibonacci hashing, Knuth 1973, section 6.4).
std::size_t hash(int a, int b) {
  const std::uint64_t product = pair_key(a, b) * 0x9E3779B97F4A7C15u;
  return static_cast<std::size_t>(product >> 32);
}

}  // namespace

/// The record of a pair; a new one stands at the end until sort_records().
template <int D>
PairRecord& ContactGrid<D>::record_of(int a, int b) {
  const std::size_t mask = places_.size() - 1;
  if (!places_.empty())
    for (std::size_t at = hash(a, b) & mask; places_[at] != 0; at = (at + 1) & mask) {
      PairRecord& record = records_[places_[at] - 1];
      if (record.a == a && record.b == b) return record;
    }
  PairRecord record;
  record.a = a;
  record.b = b;
  record.pairs = 1;
  records_.push_back(record);
  if (2 * records_.size() > places_.size()) {
    places_.assign(std::max<std::size_t>(64, 4 * places_.size()), 0);
    for (std::size_t k = 0; k < records_.size(); ++k) enter(k);
  } else {
    enter(records_.size() - 1);
  }
  return records_.back();
}

/// Note where a record is.
template <int D>
void ContactGrid<D>::enter(std::size_t record) {
  const std::size_t mask = places_.size() - 1;
  std::size_t at = hash(records_[record].a, records_[record].b) & mask;
  while (places_[at] != 0) at = (at + 1) & mask;
  places_[at] = static_cast<std::uint32_t>(record) + 1;
}

/// Put new records in their order among the old ones, and note where all are.
template <int D>
void ContactGrid<D>::sort_records() {
  std::sort(records_.begin(), records_.end(), [](const PairRecord& x, const PairRecord& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  std::fill(places_.begin(), places_.end(), 0u);
  for (std::size_t k = 0; k < records_.size(); ++k) enter(k);
}

template <int D>
ContactSums ContactGrid<D>::record(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                   double time, double time_step, std::int64_t step) {
  ContactSums sums;
  // Mass of a side's node over that of a particle.
  const auto share = [&](const Side<D>& side) {
    return grid.record_at(side.place)[mass_at] /
           bodies[static_cast<std::size_t>(side.body)].mean_mass;
  };
  const std::size_t known = records_.size();
  for (auto& r : records_) std::fill(std::begin(r.force), std::end(r.force), 0.0);
  const auto add = [&](Part& part, const ContactNode& node) {
    sums.energy += node.energy;
    sums.force_work += node.force_work;
    for (const SidePair<D>& pair : part.pairs_of(node)) {
      if (!pair.acted) continue;
      const Side<D>& side_r = part.sides_of(node)[pair.r];
      const Side<D>& side_s = part.sides_of(node)[pair.s];
      PairRecord& r =
          record_of(std::min(side_r.body, side_s.body), std::max(side_r.body, side_s.body));
      const double sign =
          side_r.body < side_s.body ? 1.0 : -1.0;  // records hold what acts on the first
      // A node that a body has only just reached tells nothing about when and where they met.
      if (r.first_step < 0 || r.first_step == step) {
        const double lighter = std::min(share(side_r), share(side_s));
        if (lighter > std::max(least_share, r.first_share)) {
          r.first_step = step;
          r.first_time = time;
          r.first_gap = pair.gap;
          r.first_share = lighter;
          const Vec<double, D> x = grid.position_of(place_of(grid, node));
          for (int a = 0; a < D; ++a) {
            r.first_normal[a] = sign * pair.normal[a];
            r.first_node[a] = x[a];
          }
        }
      }
      const Vec<double, D> impulse = pair.impulse();
      for (int a = 0; a < D; ++a) {
        r.impulse[a] += sign * impulse[a];
        r.force[a] += sign * impulse[a] / time_step;
      }
      r.friction_work += pair.friction_work;
      sums.friction += pair.friction_work;
      sums.friction_first += pair.friction_first;
    }
  };
  for (Part& part : parts_)
    for (const ContactNode& node : part.nodes) add(part, node);
  if (records_.size() > known) sort_records();
  return sums;
}

template <int D>
std::size_t ContactGrid<D>::bytes() const {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  std::size_t parts = 0;
  for (const Part& part : parts_) parts += part.bytes();
  return masses_.bytes() + parts + size(holders_) + size(tiles_) + size(last_tiles_) +
         size(travel_) + size(fastest_) + size(rigid_share_) + size(records_) + size(places_);
}

template void ContactGrid<2>::sort_records();
template void ContactGrid<3>::sort_records();
template ContactSums ContactGrid<2>::record(TileGrid<2>&, const std::vector<Body<2>>&, double,
                                            double, std::int64_t);
template ContactSums ContactGrid<3>::record(TileGrid<3>&, const std::vector<Body<3>>&, double,
                                            double, std::int64_t);
template std::size_t ContactGrid<2>::bytes() const;
template std::size_t ContactGrid<3>::bytes() const;

}  // namespace mpm
