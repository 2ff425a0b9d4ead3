#pragma once
// What the bodies of two groups do to each other.
#include <vector>

#include "mpm/domain.hpp"

namespace mpm {

/// The records of the pairs summed by groups, in the order of the groups. What bodies of one group
/// do to each other has no direction: its force and impulse are 0.
template <int D>
std::vector<PairRecord> group_pairs(const Domain<D>& domain);

}  // namespace mpm
