#pragma once
// Columns that some particles have besides; declared before their pool is filled.
#include "mpm/particles/pool.hpp"

namespace mpm {

/// Of particles with a body force, or that keep their places at the start.
template <int D>
void add_force_column(ParticlePool<D>& pool);
template <int D>
void add_start_positions(ParticlePool<D>& pool);

/// How far surfaces are set back in contact at nodes.
template <int D>
void add_set_back(ParticlePool<D>& pool);

/// Of particles that press surfaces (PressingColumns).
template <int D>
void add_pressing(ParticlePool<D>& pool);

}  // namespace mpm
