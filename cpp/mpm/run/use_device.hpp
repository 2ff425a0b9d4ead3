#pragma once
// A run whose steps a device makes. The host keeps its bodies, its ledger and the time; it is given
// the particles when somebody wants to read them.
#include "mpm/run/simulation.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/run/time_step.hpp"

namespace mpm {

/// Let a device make the steps from now on; once it is ready to step. Throws std::invalid_argument,
/// in one sentence, for what steps there do not know; std::runtime_error without a device, or with
/// too little memory.
template <int D>
void use_device(Simulation<D>& simulation) {
  require(simulation, Phase::ready, "call prepare() before use_device()");
  if (simulation.settings.grid.coarsening)
    throw std::invalid_argument(
        "steps on a device do not know grid.coarsening yet: run without one");
  if (!simulation.device) {
    simulation.device = start_on_device(simulation.domain, simulation.settings.run.scheme);
    probe_speeds(simulation.domain);  // which its lists have taken away
  }
  simulation.wants_device = true;
}

/// Give the host the particles as they are now, if a device has them; and those of bodies on nodes
/// of their own the velocities of these, of which steps have no need.
template <int D>
void bring_home(Simulation<D>& simulation) {
  if (simulation.phase == Phase::ready) give_kept_velocities(simulation.domain);
  if (simulation.device) fetch_from_device(*simulation.device, simulation.domain);
}

}  // namespace mpm
