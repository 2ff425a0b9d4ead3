#pragma once
// How bodies on nodes of their own turn (particles/kept_spin.hpp), at the start and where
// velocities are set.
#include "mpm/domain.hpp"

namespace mpm {

/// All bodies on nodes of their own, also those that walls hold.
template <int D>
void list_kept_spins(Domain<D>& domain);

/// Which of them other ranks have a part of; anew where tiles have gone to other ranks.
template <int D>
void find_shared_bodies(Domain<D>& domain);

/// How they turn, by what their nodes have.
template <int D>
void find_kept_spins(Domain<D>& domain);

/// Of all of them, as who has the first tile of each knows; to the first rank.
template <int D>
std::vector<KeptSpin> gather_kept_spins(const Domain<D>& domain);

}  // namespace mpm
