#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// See to it that each part knows the points of other bodies, and those of its own body far away in
/// it, that its points may feel: found anew when some point has moved too far since.
template <int D>
void find_near_points(Domain<D>& domain);

/// Make all lists anew, by where the points are.
template <int D>
void make_near_lists(Domain<D>& domain);

}  // namespace mpm
