#pragma once
// Bodies on nodes of their own of which particles have failed. These keep their mass, and bear only
// what presses them below their volume (materials/apply_failure.hpp): nodes between pieces still
// know each other, and nothing pulls. They are no surface any more; their neighbours are.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Count them, and make surfaces of what they uncover; behind a step, whose overlaps are known, by
/// all ranks.
template <int D>
void look_for_failed(Simulation<D>& simulation);

}  // namespace mpm
