// Wall times by stage: each at its own, no shorter than what was done and no longer than all took.
#include <algorithm>
#include <thread>

#include "check.hpp"
#include "mpm/run/timers.hpp"

void test_timers(mpm::testing::Report& report) {
  using namespace mpm;
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  StageTimers timers;
  timers.name(1, "second");
  timers.name(0, "first");
  CHECK(timers.seconds().size() == 2 && timers.seconds()[0].first == "first");
  const auto begin = Clock::now();
  int done = 0;
  for (int k = 0; k < 3; ++k)
    timers.time(1, [&] {
      ++done;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    });
  const double all = since(begin), second = timers.seconds()[1].second;
  CHECK_EQUAL(done, 3);
  CHECK(second >= 0.006 && second <= all, second, all);
  CHECK_EQUAL(timers.seconds()[0].second, 0.0);

  // Saved and restored, and not into those of other stages.
  std::vector<std::byte> file;
  const StateStream::Transfer write = [&](std::span<std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
    return bytes.size();
  };
  mpm::NoOthers nobody;
  StateStream out(StateStream::Way::save, write, nobody);
  timers.exchange(out);
  const auto restore = [&](StageTimers& into) {
    std::size_t at = 0;
    const StateStream::Transfer read = [&](std::span<std::byte> bytes) {
      const std::size_t n = std::min(bytes.size(), file.size() - at);
      std::copy_n(file.begin() + static_cast<std::ptrdiff_t>(at), n, bytes.begin());
      at += n;
      return n;
    };
    StateStream in(StateStream::Way::restore, read, nobody);
    into.exchange(in);
  };
  StageTimers same, other;
  same.name(1, "second");
  restore(same);
  CHECK_EQUAL(same.seconds()[1].second, second);
  other.name(4, "fifth");
  CHECK_THROWS(restore(other), "other stages");
  timers.reset();
  CHECK(timers.seconds()[1].second == 0.0 && timers.seconds()[1].first == "second");
}
