#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// Who follows whom of the nodes that bodies keep, (E1) of followers.hpp, once these have masses;
/// of bodies whose nodes are `laid` anew those who lead get what followers have, (E2). All ranks
/// together.
template <int D>
void find_followers(Domain<D>& domain, const std::vector<bool>& laid);

}  // namespace mpm
