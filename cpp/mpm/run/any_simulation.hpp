#pragma once
// A simulation in two or three dimensions, for those who know only when they run in how many; of
// one rank of several processes, or of several that are threads of this one, as if it were one.
#include <algorithm>
#include <exception>
#include <memory>
#include <thread>
#include <type_traits>
#include <variant>

#include "mpm/comm/counted_comm.hpp"
#include "mpm/comm/threads_comm.hpp"
#include "mpm/run/use_device.hpp"

namespace mpm {

/// The parts of a simulation, each of a rank.
template <int D>
class Team {
 public:
  /// This process's part, if `others` are processes too.
  Team(const Settings& settings, std::shared_ptr<Comm> others) {
    comms_.push_back(std::make_unique<CountedComm>(std::move(others)));
    parts_.push_back(std::make_unique<Simulation<D>>(settings, comms_[0].get()));
  }
  explicit Team(const Settings& settings)
      // A part at least, which refuses settings that are out of range.
      : world_(std::make_shared<ThreadsWorld>(std::max(1, settings.execution.ranks))) {
    for (int rank = 0; rank < world_->size(); ++rank) {
      comms_.push_back(std::make_unique<CountedComm>(std::make_shared<ThreadsComm>(world_, rank)));
      Comm* const others = world_->size() > 1 ? comms_.back().get() : nullptr;
      parts_.push_back(std::make_unique<Simulation<D>>(settings, others));
    }
  }

  /// f(part) for all parts at once, that of rank 0 by the calling thread; what it returns there. An
  /// error that all parts have leaves them as they are; after one that some have no more can be
  /// done.
  template <class F>
  auto visit(F&& f) {
    using Result = std::decay_t<decltype(f(*parts_[0]))>;
    if (parts_.size() == 1) {
      try {
        return f(*parts_[0]);
      } catch (const std::exception& error) {
        comms_[0]->fail(error.what());
        throw;
      }
    }
    std::conditional_t<std::is_void_v<Result>, std::monostate, std::unique_ptr<Result>> first;
    std::vector<std::exception_ptr> errors(parts_.size());
    const auto run = [&](std::size_t rank) {
      try {
        if constexpr (std::is_void_v<Result>) {
          f(*parts_[rank]);
        } else {
          auto result = std::make_unique<Result>(f(*parts_[rank]));
          if (rank == 0) first = std::move(result);
        }
      } catch (const std::exception& error) {
        errors[rank] = std::current_exception();
        comms_[rank]->fail(error.what());
      }
    };
    {
      std::vector<std::jthread> others;
      for (std::size_t rank = 1; rank < parts_.size(); ++rank)
        others.emplace_back([&run, rank] { run(rank); });
      run(0);
    }
    rethrow(errors);
    if constexpr (!std::is_void_v<Result>) return std::move(*first);
  }

 private:
  /// The error that is the cause, not that of those who have heard of it.
  void rethrow(const std::vector<std::exception_ptr>& errors) {
    std::exception_ptr heard;
    std::size_t causes = 0;
    std::exception_ptr cause;
    for (const std::exception_ptr& error : errors) {
      if (!error) continue;
      try {
        std::rethrow_exception(error);
      } catch (const RankFailed&) {
        heard = error;
      } catch (...) {
        ++causes;
        if (!cause) cause = error;
      }
    }
    if (causes == errors.size()) world_->recover();
    if (cause) std::rethrow_exception(cause);
    if (heard) std::rethrow_exception(heard);
  }

  std::shared_ptr<ThreadsWorld> world_;
  std::vector<std::unique_ptr<CountedComm>> comms_;
  std::vector<std::unique_ptr<Simulation<D>>> parts_;
};

class AnySimulation {
 public:
  /// Throws std::invalid_argument, in one sentence, for a setting out of range.
  explicit AnySimulation(const Settings& settings) : of_(make(settings)) {}
  /// The part of one of the ranks of `others`.
  AnySimulation(const Settings& settings, const std::shared_ptr<Comm>& others)
      : of_(others ? make(settings, others) : make(settings)) {}
  AnySimulation(const AnySimulation&) = delete;
  AnySimulation& operator=(const AnySimulation&) = delete;

  /// f(simulation), with a Simulation<2> or a Simulation<3>; of several ranks with each. What a
  /// device has of the particles may be newer than what f finds.
  template <class F>
  decltype(auto) visit_as_is(F&& f) {
    return std::visit([&](auto& team) { return team.visit(f); }, of_);
  }
  /// The same with the particles as they are now.
  template <class F>
  decltype(auto) visit(F&& f) {
    return visit_as_is([&](auto& simulation) -> decltype(auto) {
      bring_home(simulation);
      return f(simulation);
    });
  }

 private:
  using Either = std::variant<Team<2>, Team<3>>;
  template <class... Others>
  static Either make(const Settings& settings, const Others&... others) {
    if (settings.grid.dimension == 2) return Either(std::in_place_index<0>, settings, others...);
    return Either(std::in_place_index<1>, settings, others...);
  }

  Either of_;
};

}  // namespace mpm
