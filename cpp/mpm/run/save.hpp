#pragma once
// The state as it is between two steps.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Rows of the history that nobody took are in it too; functions of time are the case's. Throws
/// std::invalid_argument if there is nothing to go on from.
template <int D>
void save(Simulation<D>& simulation, const StateStream::Transfer& to);

/// Restored into a simulation of the same case that has made no step, it goes on with the same
/// bits. Throws std::invalid_argument if the state does not fit; what has been restored half is of
/// no use.
template <int D>
void restore(Simulation<D>& simulation, const StateStream::Transfer& from, std::size_t size);

}  // namespace mpm
