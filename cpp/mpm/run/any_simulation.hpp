#pragma once
// A simulation in two or three dimensions, for those who know only when they run in how many.
#include <utility>
#include <variant>

#include "mpm/run/simulation.hpp"

namespace mpm {

class AnySimulation {
 public:
  /// Throws std::invalid_argument, in one sentence, for a setting out of range.
  explicit AnySimulation(const Settings& settings) : of_(make(settings)) {}

  /// f(simulation), with a Simulation<2> or a Simulation<3>.
  template <class F>
  decltype(auto) visit(F&& f) {
    return std::visit(std::forward<F>(f), of_);
  }

 private:
  using Either = std::variant<Simulation<2>, Simulation<3>>;
  static Either make(const Settings& settings) {
    if (settings.grid.dimension == 2) return Either(std::in_place_index<0>, settings);
    return Either(std::in_place_index<1>, settings);
  }

  Either of_;
};

}  // namespace mpm
