#pragma once
// A run: what is stepped, and what is known about it. Data; what is done with it stands in the
// files beside this one, a header for each: bodies, loads, prepare, advance, time_step,
// coarsen_cells, watch, find_failure, save; and what it tells, in measures, columns, frame,
// pair_groups and warnings.
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "mpm/device/on_device.hpp"
#include "mpm/run/history_rows.hpp"
#include "mpm/run/notes.hpp"
#include "mpm/run/records.hpp"
#include "mpm/run/settings.hpp"
#include "mpm/run/timers.hpp"

namespace mpm {

/// What a simulation can be asked for: to take bodies in; to step; nothing, when preparing or
/// restoring it has failed half-way.
enum class Phase { building, ready, broken };

/// A body that does not move while the run settles (held_bodies.hpp), and what it is then.
struct HeldBody {
  int body;
  BodyKind kind;
};

/// What has passed between the ranks in steps of this process.
struct StepTraffic {
  Traffic traffic;
  double seconds = 0.0;  // of the steps
  std::int64_t steps = 0;
};

template <int D>
struct Simulation {
  /// One rank's part of a run, if `comm` names others. Throws std::invalid_argument, in one
  /// sentence, for a setting out of range.
  explicit Simulation(const Settings& given, Comm* comm = nullptr);

  Settings settings;
  Domain<D> domain;
  std::span<const Stage<D>> stages;  // of a step
  StageTimers timers;
  StepTraffic passed;
  double next_time_step = 0.0;  // [s]
  // The least that was stable since it was last looked at whether steps may be longer
  // (time_step.cpp).
  double least_stable = 0.0;  // [s]
  int coarsenings = 0;        // of the cells so far
  Phase phase = Phase::building;
  std::vector<HeldBody> held;        // until the run has settled
  std::vector<std::int64_t> flowed;  // scratch: of each body (renew_reference.hpp)
  std::optional<Failure> failure;
  Watch<D> watch;
  double pressed_further = 0.0;         // in this step, of all that bodies are pressed (settle.hpp)
  bool wants_device = false;            // to make the steps (use_device.hpp) ...
  std::unique_ptr<OnDevice<D>> device;  // ... and has the particles
  HistoryRows history;
};

/// The stages of a step, by the settings and by the kinds of the bodies that there are.
template <int D>
void choose_stages(Simulation<D>& simulation);

/// Throws std::invalid_argument with the sentence unless the simulation is in a phase.
template <int D>
void require(const Simulation<D>& simulation, Phase phase, const char* sentence) {
  if (simulation.phase == Phase::broken)
    throw std::invalid_argument(
        "preparing or restoring this simulation, or a step of it, has failed: make a new one");
  if (simulation.phase != phase) throw std::invalid_argument(sentence);
}

extern template struct Simulation<2>;
extern template struct Simulation<3>;

}  // namespace mpm
