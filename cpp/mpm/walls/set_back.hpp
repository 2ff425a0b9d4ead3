#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// Before the first step: surfaces of particles that walls which touch overlap are set back by
/// that, as where bodies overlap (contact/set_back.hpp).
template <int D>
void set_back_at_walls(Domain<D>& domain);

}  // namespace mpm
