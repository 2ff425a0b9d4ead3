#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// A rigid body meets others with its whole mass, spread over its overlapped nodes; one whose
/// motion is prescribed mostly with an infinite mass.
template <int D>
void share_rigid_masses(Contact<D>& contact, const std::vector<Body<D>>& bodies, Comm& comm);

}  // namespace mpm
