#pragma once
// The time loop.
#include <atomic>

#include "mpm/run/simulation.hpp"

namespace mpm {

/// Make up to `max_steps` steps, to `end_time` at most; returns how many. Stops early at a failure,
/// and after the step in which `stop`, if there is one, has become true.
template <int D>
std::int64_t advance(Simulation<D>& simulation, std::int64_t max_steps, double end_time,
                     const std::atomic<bool>* stop = nullptr);

}  // namespace mpm
