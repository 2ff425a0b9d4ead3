#pragma once
// Bodies on nodes of their own whose pressures are averaged once they flow
// (step/average_in_body.cpp): points of what flows have pressures that are mostly noise, while what
// is elastic would bend more softly by some per cent.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Begin with the bodies of which a share of the particles has flowed beyond the proof strain;
/// between two steps, by all ranks. Not those of which particles have failed.
template <int D>
void average_what_flows(Simulation<D>& simulation);

}  // namespace mpm
