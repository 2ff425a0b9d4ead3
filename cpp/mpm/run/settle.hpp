#pragma once
// The way to rest before a run: under the loads of the time 0, with local damping, until forces
// balance (decision 0050).
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Set the clock of a run that settles to before 0; once all bodies are there.
template <int D>
void start_settling(Simulation<D>& simulation);

/// What is otherwise in such a step: prescribed bodies stand still, as those do that are held, and
/// all others have its damping.
template <int D>
void begin_settling_step(Simulation<D>& simulation);

/// When forces balance, or the time is over: take the velocities, set the clock to 0, and give the
/// bodies those velocities that they have at the start.
template <int D>
void end_settling_step(Simulation<D>& simulation);

}  // namespace mpm
