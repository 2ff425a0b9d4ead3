#pragma once
// Whether a state that was restored is one that a run can have. They throw std::invalid_argument,
// on all ranks, if no step can have left it so.
#include "mpm/run/save_particles.hpp"
#include "mpm/run/simulation.hpp"

namespace mpm {

/// The cells, and motions of bodies.
template <int D>
void check_grid(const Domain<D>& domain);
/// The particles of a pool that a rank has.
template <int D>
void check_particles(const Domain<D>& domain, std::size_t pool, std::span<const PlacedRow> rows,
                     const StateStream& stream);
/// All else, when it has been restored.
template <int D>
void check_rest(const Simulation<D>& simulation, const StateStream& stream);

}  // namespace mpm
