#pragma once
// What ranks tell each other of surfaces (other_ranks.hpp).
#include "mpm/domain.hpp"

namespace mpm {

/// Where all points of bodies that deform are by now, to all.
template <int D>
void tell_all_places(Domain<D>& domain);

/// Ask for the points of others that may be felt by now, and those that points are bonded to.
template <int D>
void ask_for_awake(Domain<D>& domain);

/// Where these are, and how their hosts move.
template <int D>
void tell_awake(Domain<D>& domain);

/// How the hosts move that particles press and nobody has told of.
template <int D>
void ask_for_pressed(Domain<D>& domain);

/// How bodies turn and move as wholes, to all: restitution asks for it.
template <int D>
void tell_motions(Domain<D>& domain);

}  // namespace mpm
