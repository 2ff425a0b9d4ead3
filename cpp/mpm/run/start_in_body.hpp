#pragma once
// Bodies on nodes of their own (step/kept_nodes.hpp): their nodes at the start, and the velocities
// of their particles, which nothing in a step asks for.
#include <vector>

#include "mpm/domain.hpp"

namespace mpm {

/// Throws std::invalid_argument, in one sentence, for what such bodies do not go with yet.
template <int D>
void check_in_body(const Domain<D>& domain);

/// The places of the particles in their bodies, F = 1, and the masses of the nodes, which are at
/// rest where they are; once lists are made.
template <int D>
void start_in_body(Domain<D>& domain);

/// The velocities of the nodes from those of the particles, of bodies that are meant; of all if
/// none are named. The motion that is rigid is met exactly, and momentum kept.
template <int D>
void find_kept_velocities(Domain<D>& domain, const std::vector<bool>& bodies = {});

/// v_p = sum N_ip v_i of the particles, for those who read it between steps.
template <int D>
void give_kept_velocities(Domain<D>& domain);

}  // namespace mpm
