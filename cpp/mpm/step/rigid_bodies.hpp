#pragma once
// Bodies that move as one.
#include "mpm/domain.hpp"

namespace mpm {

/// Replace the velocities of rigid bodies' particles by the rigid motion of the same momentum and
/// angular momentum, as far as walls let them go.
template <int D>
void hold_rigid_bodies(Domain<D>& domain);

/// Positions of rigid bodies' particles after the step, in place of eq. (16).
template <int D>
void move_rigid_bodies(Domain<D>& domain);

}  // namespace mpm
