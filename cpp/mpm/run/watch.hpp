#pragma once
// Looks whether what a run computes can be so: notes what may be wrong, and stops what is.
#include "mpm/run/simulation.hpp"

namespace mpm {

inline constexpr std::int64_t look_every = 64;  // steps

/// Judge the step that has been made, by the ledger and the next time step.
template <int D>
void watch_step(Simulation<D>& simulation);

/// Look at the places and volumes of all particles, in the order of the bodies' lists, which no
/// number of threads changes; some ten operations for each. Sets `failure` if it is too much.
template <int D>
void look(Simulation<D>& simulation);

/// See how things are at the start, by which later looks judge.
template <int D>
void look_at_start(Simulation<D>& simulation);

}  // namespace mpm
