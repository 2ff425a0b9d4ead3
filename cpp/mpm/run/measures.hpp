#pragma once
// Sums over the particles, as they are between two steps.
#include <array>
#include <vector>

#include "mpm/run/simulation.hpp"

namespace mpm {

template <int D>
double total_mass(const Domain<D>& domain);  // of all particles, those that are removed too [kg]
template <int D>
double kinetic_energy(Domain<D>& domain);  // [J]
template <int D>
std::array<double, 3> momentum(Domain<D>& domain);  // [kg m/s]
/// What the material of a particle has at the start: the energy of its equation of state, or the
/// elastic one of the stress that it begins with, V (p^2 / 2K + s:s / 4G) [J].
template <int D>
double energy_at_start(const ParticlePool<D>& pool, const Body<D>& body, std::uint32_t row);
/// Of all particles [J].
template <int D>
double initial_internal_energy(const Domain<D>& domain);
template <int D>
std::size_t particle_count(const Domain<D>& domain);
inline RemovedSum sum_of(const Removed& removed, Comm& comm) {
  const RemovedTotal total = total_of(removed, comm);
  return {total.mass, total.count};
}

template <int D>
ContactSummary contact_summary(const Simulation<D>& simulation);
/// By all ranks at once.
template <int D>
RanksSummary ranks_summary(const Simulation<D>& simulation);
/// Of the faces that are not free, in the order x_min, x_max, y_min, ...; by all ranks at once.
template <int D>
std::vector<FaceRecord> face_records(const Domain<D>& domain);
/// Memory of all ranks, by all at once.
template <int D>
Bytes bytes_of(const Simulation<D>& simulation);

}  // namespace mpm
