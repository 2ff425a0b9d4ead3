#include <algorithm>

#include "mpm/contact/contact_grid.hpp"

namespace mpm {

template <int D>
PairRecord& ContactGrid<D>::record_of(int a, int b) {
  const auto at =
      std::lower_bound(records_.begin(), records_.end(), std::pair(a, b),
                       [](const PairRecord& x, const auto& y) { return std::pair(x.a, x.b) < y; });
  if (at != records_.end() && at->a == a && at->b == b) return *at;
  PairRecord record;
  record.a = a;
  record.b = b;
  return *records_.insert(at, record);
}

template <int D>
ContactSums ContactGrid<D>::record(double time, double time_step, std::int64_t step) {
  ContactSums sums;
  for (auto& r : records_) std::fill(std::begin(r.force), std::end(r.force), 0.0);
  for (const ContactNode& node : nodes_) {
    sums.energy += node.energy;
    sums.force_work += node.force_work;
    for (std::uint32_t k = 0; k < pair_count(node.sides); ++k) {
      const SidePair<D>& pair = pairs_[node.first_pair + k];
      if (!pair.acted) continue;
      const int body_r = sides_[node.first_side + pair.r].body;
      const int body_s = sides_[node.first_side + pair.s].body;
      PairRecord& r = record_of(std::min(body_r, body_s), std::max(body_r, body_s));
      const double sign = body_r < body_s ? 1.0 : -1.0;  // records hold what acts on the first
      if (r.first_step < 0) {
        r.first_step = step;
        r.first_time = time;
        r.first_gap = pair.gap;
      }
      if (r.first_step == step) r.first_gap = std::min(r.first_gap, pair.gap);
      for (int a = 0; a < D; ++a) {
        r.impulse[a] += sign * pair.impulse[a];
        r.force[a] += sign * pair.impulse[a] / time_step;
      }
      r.friction_work += pair.friction_work;
      sums.friction += pair.friction_work;
      sums.friction_first += pair.friction_first;
    }
  }
  return sums;
}

template <int D>
std::size_t ContactGrid<D>::bytes() const {
  return holders_.capacity() * sizeof(TileHolder) + tiles_.capacity() * sizeof(ContactTile<D>) +
         counts_.capacity() * sizeof(TileCounts) + nodes_.capacity() * sizeof(ContactNode) +
         sides_.capacity() * sizeof(Side<D>) + pairs_.capacity() * sizeof(SidePair<D>) +
         records_.capacity() * sizeof(PairRecord);
}

template PairRecord& ContactGrid<2>::record_of(int, int);
template PairRecord& ContactGrid<3>::record_of(int, int);
template ContactSums ContactGrid<2>::record(double, double, std::int64_t);
template ContactSums ContactGrid<3>::record(double, double, std::int64_t);
template std::size_t ContactGrid<2>::bytes() const;
template std::size_t ContactGrid<3>::bytes() const;

}  // namespace mpm
