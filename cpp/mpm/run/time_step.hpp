#pragma once
// The time step that is stable, and the particle that limits it.
#include "mpm/domain.hpp"
#include "mpm/run/records.hpp"

namespace mpm {

/// Find the speeds that limit the time step from the present state; a step finds them by itself.
template <int D>
void probe_speeds(Domain<D>& domain);

/// The share `cfl` of the time in which the fastest wave or particle passes a cell [s].
template <int D>
double stable_time_step(const Domain<D>& domain, double cfl);

template <int D>
Limiter find_limiter(const Domain<D>& domain);

}  // namespace mpm
