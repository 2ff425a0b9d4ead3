#include "mpm/parallel/threads.hpp"

#include <algorithm>

namespace mpm {
namespace {

// Stages follow one another within microseconds, so a thread spins this often before it sleeps.
constexpr int spins_before_sleep = 20000;
constexpr int spins_before_yield =
    2000;  // beyond it, let another thread have the core: there may be more threads than cores

void pause(int spin) {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
  if (spin > spins_before_yield) std::this_thread::yield();
}

}  // namespace

void Threads::resize(int count) {
  stop();
  stopping_ = false;
  for (int k = 1; k < count; ++k) {
    workers_.emplace_back([this, seen = job_.load()]() mutable {
      for (;;) {
        for (int spin = 0; job_.load(std::memory_order_acquire) == seen; ++spin) {
          if (spin < spins_before_sleep) {
            pause(spin);
          } else {
            job_.wait(seen, std::memory_order_acquire);
          }
        }
        ++seen;
        if (stopping_) return;
        work();
        running_.fetch_sub(1, std::memory_order_release);
      }
    });
  }
}

void Threads::work() {
  for (;;) {
    const std::size_t begin = next_.fetch_add(chunk_, std::memory_order_relaxed);
    if (begin >= total_) return;
    run_(context_, begin, std::min(begin + chunk_, total_));
  }
}

void Threads::share_out(std::size_t n, Run run, void* context) {
  if (workers_.empty() || n == 1) return run(context, 0, n);
  total_ = n;
  // Eight chunks a thread: small enough to balance patches of different fill, large enough to stay
  // in step.
  chunk_ = std::max<std::size_t>(1, n / (8 * static_cast<std::size_t>(count())));
  run_ = run;
  context_ = context;
  next_.store(0, std::memory_order_relaxed);
  running_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  work();
  for (int spin = 0; running_.load(std::memory_order_acquire) != 0; ++spin) pause(spin);
}

void Threads::stop() {
  if (workers_.empty()) return;
  stopping_ = true;
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  for (auto& worker : workers_) worker.join();
  workers_.clear();
}

}  // namespace mpm
