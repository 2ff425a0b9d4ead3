#pragma once
// Wall time of each stage of the step, by the stage's name.
#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

#include "mpm/state/state_stream.hpp"

namespace mpm {

class StageTimers {
 public:
  void name(std::size_t stage, std::string_view text) {
    if (seconds_.size() <= stage) seconds_.resize(stage + 1);
    seconds_[stage].first = text;
  }
  template <class F>
  void time(std::size_t stage, F&& f) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    seconds_[stage].second +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  const std::vector<std::pair<std::string_view, double>>& seconds() const { return seconds_; }
  void exchange(StateStream& stream) {
    stream.same(seconds_.size(), "it was made with other stages (fused or not)");
    for (auto& s : seconds_) stream(s.second);
  }
  void reset() {
    for (auto& s : seconds_) s.second = 0.0;
  }

 private:
  std::vector<std::pair<std::string_view, double>> seconds_;
};

}  // namespace mpm
