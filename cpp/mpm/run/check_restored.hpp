#pragma once
// Whether a state that was restored is one that a run can have. They throw std::invalid_argument if
// no step can have left it so.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Bodies and patches: what numbers the particles and says where they are.
template <int D>
void check_lists(const Domain<D>& domain);
/// All else, when it has been restored.
template <int D>
void check_rest(const Simulation<D>& simulation);

}  // namespace mpm
