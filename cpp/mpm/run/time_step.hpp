#pragma once
// The time step that is stable, and the particle that limits it.
#include <string>

#include "mpm/run/simulation.hpp"

namespace mpm {

/// Sums per patch again, of zero, where a device has made the last step.
template <int D>
void sum_by_patch(Domain<D>& domain) {
  if (domain.sums_of.empty()) return;
  domain.sums.assign(domain.grid.patches.size(), {});
  domain.sums_of.clear();
}

/// Find the speeds that limit the time step from the present state; a step finds them by itself.
template <int D>
void probe_speeds(Domain<D>& domain);

/// The share `cfl` of the time in which the fastest wave or particle passes a cell [s]: of the
/// largest stable step.
template <int D>
double stable_time_step(const Domain<D>& domain, double cfl);

/// Choose the next step by `run.time_step`, `run.cfl` and `run.largest_time_step`. Returns what is
/// wrong with it, in one sentence; empty if nothing.
template <int D>
std::string choose_time_step(Simulation<D>& simulation);

/// Is a step held while it is stable? Steps that follow waves, which are faster in what is
/// squeezed, make energy of vibrations where nodes keep their velocities: 1 to 9 % in some hundred
/// periods.
template <int D>
bool holds_time_step(const Simulation<D>& simulation);

/// The same; what is wrong is a failure of the run.
template <int D>
void update_time_step(Simulation<D>& simulation);

template <int D>
Limiter find_limiter(const Domain<D>& domain);

}  // namespace mpm
