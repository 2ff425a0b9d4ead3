#pragma once
// A run: what is stepped, and what is known about it. Data; what is done with it stands in the
// files beside this one, a header for each: bodies, loads, prepare, advance, time_step,
// coarsen_cells, watch, find_failure, save; and what it tells, in measures, columns, frame,
// pair_groups and warnings.
#include <optional>
#include <span>

#include "mpm/domain.hpp"
#include "mpm/run/history_rows.hpp"
#include "mpm/run/notes.hpp"
#include "mpm/run/records.hpp"
#include "mpm/run/settings.hpp"
#include "mpm/run/timers.hpp"

namespace mpm {

template <int D>
struct Simulation {
  /// Throws std::invalid_argument, in one sentence, for a setting out of range.
  explicit Simulation(const Settings& given);

  Settings settings;
  Domain<D> domain;
  std::span<const Stage<D>> stages;  // of a step
  StageTimers timers;
  double next_time_step = 0.0;  // [s]
  int coarsenings = 0;          // of the cells so far
  bool prepared = false;
  std::optional<Failure> failure;
  Watch<D> watch;
  HistoryRows history;
};

extern template struct Simulation<2>;
extern template struct Simulation<3>;

}  // namespace mpm
