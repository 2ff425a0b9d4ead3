#include "mpm/run/pair_groups.hpp"

#include <algorithm>
#include <map>

namespace mpm {

template <int D>
std::vector<PairRecord> group_pairs(const Domain<D>& domain) {
  const auto group_of = [&](int body) {
    return domain.bodies[static_cast<std::size_t>(body)].group;
  };
  std::map<std::pair<int, int>, PairRecord> found;
  for (const PairRecord& pair : domain.contact.records.of_all_ranks(*domain.grid.partition.comm)) {
    const int a = group_of(pair.a), b = group_of(pair.b);
    const auto key = std::minmax(a, b);
    PairRecord& sum = found.try_emplace(key).first->second;
    sum.a = key.first;
    sum.b = key.second;
    ++sum.pairs;
    sum.friction_work += pair.friction_work;
    const double sign = a < b ? 1.0 : a > b ? -1.0 : 0.0;
    if (pair.first_step >= 0 && (sum.first_step < 0 || pair.first_step < sum.first_step)) {
      sum.first_step = pair.first_step;
      sum.first_time = pair.first_time;
      sum.first_gap = pair.first_gap;
      sum.first_share = pair.first_share;
      for (int k = 0; k < 3; ++k) {
        sum.first_normal[k] = (a > b ? -1.0 : 1.0) * pair.first_normal[k];
        sum.first_node[k] = pair.first_node[k];
      }
    }
    for (int k = 0; k < 3; ++k) {
      sum.force[k] += sign * pair.force[k];
      sum.impulse[k] += sign * pair.impulse[k];
    }
  }
  std::vector<PairRecord> records;
  records.reserve(found.size());
  for (const auto& [key, sum] : found) records.push_back(sum);
  return records;
}

template std::vector<PairRecord> group_pairs<2>(const Domain<2>&);
template std::vector<PairRecord> group_pairs<3>(const Domain<3>&);

}  // namespace mpm
