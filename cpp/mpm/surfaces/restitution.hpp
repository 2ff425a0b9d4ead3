#pragma once
#include <algorithm>
#include <utility>

#include "mpm/domain.hpp"

namespace mpm {

/// Do any pairs of bodies lose energy as they part?
inline bool restitution_takes(const ContactSettings& settings) {
  return settings.restitution < 1.0 ||
         std::ranges::any_of(
             settings.pair_laws, [](const auto& x) { return x.second.restitution < 1.0; });
}

/// Forces between bodies as wholes that take the energy which their restitution leaves not. Needs
/// sum_between().
template <int D>
void add_restitution(Domain<D>& domain);

/// Of the normal force that springs of the two have, what the bodies feel by add_restitution() of
/// the step before: Coulomb's law bounds friction by that. Where restitution_takes().
template <int D>
double left_by_restitution(const Domain<D>& domain, int body, Opposite opposite) {
  const std::vector<ActingBetween<D>>& all = domain.surfaces.between;
  const bool is_first = is_wall(opposite) || body <= opposite;
  const auto wanted = is_first ? std::pair(body, opposite) : std::pair(opposite, body);
  const auto at = std::ranges::lower_bound(
      all, wanted, {}, [](const ActingBetween<D>& pair) { return std::pair(pair.a, pair.b); });
  return at != all.end() && at->a == wanted.first && at->b == wanted.second ? at->left : 1.0;
}

}  // namespace mpm
