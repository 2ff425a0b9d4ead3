#include "mpm/run/advance.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "mpm/comm/all_sums.hpp"
#include "mpm/run/average_what_flows.hpp"
#include "mpm/run/coarsen_cells.hpp"
#include "mpm/run/find_failure.hpp"
#include "mpm/run/look_for_failed.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/renew_reference.hpp"
#include "mpm/run/settle.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/run/use_device.hpp"
#include "mpm/run/watch.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/overlap.hpp"

namespace mpm {
namespace {

/// Say when the step is, and what is a function of time in it.
template <int D>
void begin_step(Domain<D>& domain, double time_after) {
  const double from = load_time(domain.time), to = load_time(time_after);
  for (std::size_t a = 0; a < D; ++a)
    domain.gravity[static_cast<int>(a)] = domain.gravity_of_time[a].mean(from, to);
  for (Damping& damping : domain.dampings) damping.begin_step(from, to);
  for (const std::size_t b : domain.prescribed) domain.bodies[b].motion->begin_step(from, to);
  domain.time_after = time_after;
}

/// Look at all particles; those on a device only if it has seen something. It has no rigid bodies.
template <int D>
void look_or_trust(Simulation<D>& simulation) {
  if (simulation.device && simulation.device->report.odd == 0 && !simulation.domain.has_rigid()) {
    simulation.watch.looked = simulation.domain.step;
    return;
  }
  bring_home(simulation);
  look(simulation);
}

/// How long the coming step is, of the time that is left. Never a tiny one, in which forces would
/// be rounding: the last two are of equal length; where steps are held, as their changes make
/// energy, all that are left.
template <int D>
double step_towards(const Simulation<D>& simulation, double left) {
  const double longest = simulation.next_time_step;
  if (longest >= left) return left;
  if (!holds_time_step(simulation)) return std::min(longest, 0.5 * left);
  // What is left may be a whole number of steps but for rounding.
  const double steps = std::ceil(left / longest - 1e-6);
  return steps > 1.0 ? left / steps : left;
}

template <int D>
void make_step(Simulation<D>& simulation, double time_after) {
  Domain<D>& domain = simulation.domain;
  begin_step(domain, time_after);
  if (domain.settles()) begin_settling_step(simulation);
  const bool looks = (domain.step + 1) % look_every == 0;
  if (simulation.device) {
    simulation.phase = Phase::broken;  // what a device has made half must not step
    step_on_device(*simulation.device, domain, looks);
    simulation.phase = Phase::ready;
  } else {
    run_stages(domain, simulation.stages, [&](std::size_t k) {
      simulation.timers.time(k, [&] { simulation.stages[k].run(domain); });
    });
  }
  const bool settling = domain.settles();
  domain.time = time_after;
  ++domain.step;
  if (settling) end_settling_step(simulation);
  simulation.history.add(step_state(domain));
  find_failure(simulation);
  if (simulation.failure) return;
  update_time_step(simulation);
  if (simulation.failure) return;
  watch_step(simulation);
  if (looks) look_or_trust(simulation);
  if (must_coarsen(simulation)) coarsen_cells(simulation);
}

}  // namespace

template <int D>
std::int64_t advance(Simulation<D>& simulation, std::int64_t max_steps, double end_time,
                     const std::atomic<bool>* stop) {
  require(simulation, Phase::ready, "call prepare() before advance()");
  if (!std::isfinite(end_time)) throw std::invalid_argument("end_time must be a finite number");
  if (simulation.wants_device) use_device(simulation);
  Domain<D>& domain = simulation.domain;
  Comm& comm = *domain.grid.partition.comm;
  const Traffic before = comm.traffic();
  const auto begin = std::chrono::steady_clock::now();
  std::int64_t made = 0;
  while (made < max_steps && domain.time < end_time && !simulation.failure) {
    average_what_flows(simulation);
    renew_references(simulation);
    const double next_stop = domain.settles() ? std::min(end_time, 0.0) : end_time;
    const double left = next_stop - domain.time;
    const double step = step_towards(simulation, left);
    // What is strained before forces (USF) has no velocity from before the time 0.
    domain.step_before = domain.time == 0.0 ? 0.0 : domain.time_step;
    domain.time_step = step;
    domain.shift_before = domain.shift;
    domain.shift = holds_time_step(simulation) ? shift_between(domain.step_before, step) : 0.0;
    make_step(simulation, step == left ? next_stop : domain.time + step);
    ++made;
    if (!simulation.failure) look_for_failed(simulation);
    // All ranks after the same step.
    const bool told = stop != nullptr && stop->load(std::memory_order_relaxed);
    if (any_of_all(comm, told)) break;
  }
  simulation.passed.traffic += comm.traffic() - before;
  simulation.passed.seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  simulation.passed.steps += made;
  const bool looked = simulation.watch.looked == domain.step;
  if (made > 0 && domain.time >= end_time && !looked && !simulation.failure) {
    bring_home(simulation);
    look(simulation);
  }
  return made;
}

template std::int64_t advance<2>(Simulation<2>&, std::int64_t, double, const std::atomic<bool>*);
template std::int64_t advance<3>(Simulation<3>&, std::int64_t, double, const std::atomic<bool>*);

}  // namespace mpm
