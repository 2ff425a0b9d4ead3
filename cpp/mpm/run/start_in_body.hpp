#pragma once
// Bodies on nodes of their own (step/kept_nodes.hpp): their nodes at the start, and the velocities
// of their particles, which nothing in a step asks for.
#include <vector>

#include "mpm/run/simulation.hpp"

namespace mpm {

/// Throw std::invalid_argument, in one sentence, for matter that does not hold together, and for
/// what such bodies do not go with yet.
void check_in_body(const Material& material);
template <int D>
void check_in_body(const Simulation<D>& simulation);

/// The masses of the nodes that are new to some bodies; all nodes are cleared. Who follows is not
/// known yet.
template <int D>
void lay_nodes(Domain<D>& domain, const std::vector<bool>& bodies);

/// The masses of the nodes, which have their places and the velocities of the particles; once lists
/// are made.
template <int D>
void start_in_body(Domain<D>& domain);

/// The velocities of the nodes from those of the particles, of bodies that are meant; of all if
/// none are named. Rigid motions are met exactly, and momentum is kept; then the particles have
/// what the nodes give them.
template <int D>
void find_kept_velocities(Domain<D>& domain, const std::vector<bool>& bodies = {});

/// Bring all nodes to rest.
template <int D>
void stop_kept_nodes(Domain<D>& domain);

/// v_p = sum N_ip v_i of the particles at the end of the last step, for those who read it there.
template <int D>
void give_kept_velocities(Domain<D>& domain);

}  // namespace mpm
