#pragma once
#include "mpm/run/simulation.hpp"
#include "mpm/state/state_stream.hpp"

namespace mpm {

/// What nodes in bodies keep. Their patches and blocks follow from the places of the particles in
/// their bodies, which never change.
template <int D>
void exchange_kept_nodes(Domain<D>& domain, StateStream& stream);

/// How these bodies turn.
template <int D>
void exchange_kept_spins(Domain<D>& domain, StateStream& stream);

}  // namespace mpm
