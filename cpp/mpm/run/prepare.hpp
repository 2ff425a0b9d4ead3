#pragma once
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Sort the particles, make the grid, find the first time step. Once, after the last body. Throws
/// std::invalid_argument, in one sentence, if there is nothing to step.
template <int D>
void prepare(Simulation<D>& simulation);

}  // namespace mpm
