#pragma once
// Why a run cannot go on.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Sets `failure` if the step that has been made has left numbers that no step can go on from.
template <int D>
void find_failure(Simulation<D>& simulation);

/// A failure at a particle, with the sentence that says so.
template <int D>
Failure failure_at(const Domain<D>& domain, const std::string& kind, std::size_t body,
                   std::size_t row, const std::string& what);

/// The row of a particle, by its number in the order in which the user gave them.
template <int D>
std::size_t row_of(const Domain<D>& domain, int body, std::int64_t particle);

}  // namespace mpm
