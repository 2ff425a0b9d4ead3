#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// What passes between the bodies in the coming step, pair by pair; and between them and faces of
/// the box where restitution takes energy.
template <int D>
void sum_between(Domain<D>& domain);

/// Record what has passed between them in the step.
template <int D>
void record_between(Domain<D>& domain);

}  // namespace mpm
