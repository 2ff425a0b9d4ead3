#pragma once
// Bodies that have a velocity at the start do not move while the run settles: until the time 0 they
// are as bodies that are fixed, whatever acts on them, and then get it (decision 0050).
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Find them, and give their pools a column for the velocity; before pools are filled.
template <int D>
void find_held_bodies(Simulation<D>& simulation);

/// Keep their velocities, and hold them; once all else is as at the start. Throws
/// std::invalid_argument if none is left that could settle.
template <int D>
void hold_bodies(Simulation<D>& simulation);

/// Make them again what they are; their velocities stay zero.
template <int D>
void free_held_bodies(Simulation<D>& simulation);

/// All that have a velocity at the time 0 get it: those that were held, and those of which the
/// motion is prescribed, which stood still. The ledger counts what this takes as the work and the
/// impulse of prescribed motions.
template <int D>
void start_moving(Simulation<D>& simulation);

/// Give the particles of bodies with prescribed motion its velocities.
template <int D>
void set_prescribed_velocities(Domain<D>& domain);

}  // namespace mpm
