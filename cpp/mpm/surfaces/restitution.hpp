#pragma once
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

}  // namespace mpm
