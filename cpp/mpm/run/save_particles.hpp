#pragma once
// The columns of particles in the user's order, so that who has them, and where their rows lie,
// says nothing about a state.
#include "mpm/domain.hpp"
#include "mpm/state/state_stream.hpp"

namespace mpm {

/// A particle of this rank: its place among all of its pool, by body, then by number; and its row.
struct PlacedRow {
  std::uint32_t place, row;
};

/// Save or restore the particles of a pool. Restored, the rows that this rank has hold values that
/// have been looked at; those that were removed are in ParticlePool::removed, and the patches of
/// `bodies`, one for each, hold the others until lists are built.
template <int D>
void exchange_particles(Domain<D>& domain, std::size_t pool, StateStream& stream,
                        std::vector<Patch<D>>& bodies);

}  // namespace mpm
