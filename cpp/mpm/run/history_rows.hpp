#pragma once
// The rows of the history that nobody has taken yet.
#include <utility>
#include <vector>

#include "mpm/domain.hpp"
#include "mpm/ledger/history.hpp"
#include "mpm/state/state_stream.hpp"

namespace mpm {

template <int D>
StepState step_state(const Domain<D>& domain) {
  return {domain.ledger,    domain.step,           domain.time,
          domain.time_step, domain.grid.cell_size, all_patches(domain.grid),
          domain.renewals};
}

/// Room is made once, for the row of the start and `capacity` steps; a caller who never takes them
/// loses the oldest.
class HistoryRows {
 public:
  static constexpr std::int64_t capacity = 4096;

  HistoryRows() { values_.reserve(most); }
  void add(const StepState& state) {
    if (values_.size() > most - history_terms.size()) values_.clear();
    for (const HistoryTerm& term : history_terms) values_.push_back(term.value(state));
  }
  /// All of them, row by row.
  std::vector<double> take() {
    std::vector<double> rows = values_;
    values_.clear();
    return rows;
  }
  void exchange(StateStream& stream) { stream.vector(values_); }
  /// Can steps have left it so? What is restored may be anything.
  bool plausible() const {
    return values_.size() % history_terms.size() == 0 && values_.size() <= most;
  }
  std::size_t bytes() const { return bytes_of(values_); }

 private:
  static constexpr std::size_t most = (capacity + 1) * history_terms.size();
  std::vector<double> values_;
};

}  // namespace mpm
