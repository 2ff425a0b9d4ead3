#pragma once
// Why a run cannot go on.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Sets `failure` if the step that has been made has left numbers that no step can go on from.
template <int D>
void find_failure(Simulation<D>& simulation);

/// A failure at a particle, or at none, with the sentence that says so.
template <int D>
Failure failure_at(const Domain<D>& domain, const std::string& kind, const ParticleAt& at,
                   const std::string& what);

/// A failure as bytes, and back.
std::vector<std::byte> to_bytes(const Failure& failure);
Failure failure_from(std::span<const std::byte> bytes);

}  // namespace mpm
