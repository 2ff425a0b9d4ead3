#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// When a step ends, and how long it is.
struct StepEnd {
  double time, time_step;  // [s]
  std::int64_t step;
};

/// Add this step's impulses and work to the records of the pairs and give the sums for the ledger.
template <int D>
ContactSums record_pairs(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                         const StepEnd& end, Threads& threads);

}  // namespace mpm
