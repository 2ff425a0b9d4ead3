#pragma once
// What body forces do in a step, beside the stage that adds them.
#include "mpm/domain.hpp"
#include "mpm/ledger/work.hpp"

namespace mpm {

/// Work of the body force on a patch, with the velocities and increments of its nodes.
template <int D>
Work work_of_body_force(Domain<D>& domain, std::size_t patch);

}  // namespace mpm
