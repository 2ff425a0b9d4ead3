#pragma once
// What followers give and take in a step (followers.hpp). All ranks together.
#include "mpm/domain.hpp"

namespace mpm {

/// Forces of followers go to those who lead, (E2), with what walls give where these lie beyond.
template <int D>
void give_forces_to_leading(Domain<D>& domain);
/// The same of other vectors, at a number of the records; followers are left with none.
template <int D>
void give_to_leading(Domain<D>& domain, int at);
/// Followers take the vectors at a number of the records from those who lead, (E1).
template <int D>
void take_from_leading(Domain<D>& domain, int at);

/// 1 of the patches with nodes that follow.
template <int D>
const std::vector<std::uint8_t>& patches_that_follow(Domain<D>& domain);

/// As vectors, numbers beside the displacements, which have no direction.
template <int D>
void give_number_to_leading(Domain<D>& domain, int at);
template <int D>
void take_number_from_leading(Domain<D>& domain, int at);

}  // namespace mpm
