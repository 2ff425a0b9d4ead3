#pragma once
// What the stress has done in the bodies of each group so far. Of a rank in its own patches: sums
// in integers may be added up at any time.
#include <array>
#include <vector>

#include "mpm/ledger/patch_sums.hpp"

namespace mpm {

struct PartEnergies {
  std::array<ExactSum, 3> sums;  // of the values of PartWork

  void add(const std::array<double, 3>& values) {
    for (std::size_t k = 0; k < sums.size(); ++k)
      if (values[k] != 0.0) sums[k].add(values[k]);
  }
};

/// [J]
struct PartWork {
  double internal = 0.0;  // with that of the start, and of particles that take no part any more
  double plastic = 0.0, viscous = 0.0;
};
/// Of each group, by all ranks.
inline std::vector<PartWork> total_of(const std::vector<PartEnergies>& parts, Comm& comm) {
  std::vector<ExactSum> sums;
  sums.reserve(3 * parts.size());
  for (const PartEnergies& part : parts)
    sums.insert(sums.end(), part.sums.begin(), part.sums.end());
  all_sum(comm, sums);
  std::vector<PartWork> found;
  found.reserve(parts.size());
  for (std::size_t k = 0; k < sums.size(); k += 3)
    found.push_back({sums[k].value(), sums[k + 1].value(), sums[k + 2].value()});
  return found;
}

}  // namespace mpm
