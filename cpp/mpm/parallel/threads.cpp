#include "mpm/parallel/threads.hpp"

#include <algorithm>

namespace mpm {
namespace {

// Stages follow one another within microseconds, so a thread spins this often before it sleeps.
constexpr int spins_before_sleep = 20000;
constexpr int spins_before_yield =
    2000;  // beyond it, let another thread have the core: there may be more threads than cores

constexpr int index_bits = 32;
constexpr std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1;

std::uint64_t packed(std::uint64_t begin, std::uint64_t end) { return end << index_bits | begin; }

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
  balanced_ = 0;
  starts_.assign(static_cast<std::size_t>(std::max(count, 1)) + 1, 0);
  parts_ = std::make_unique<Part[]>(static_cast<std::size_t>(std::max(count, 1)));
  for (int k = 1; k < count; ++k) {
    const auto self = static_cast<std::size_t>(k);
    workers_.emplace_back([this, self, seen = job_.load()]() mutable {
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
        work(self);
        running_.fetch_sub(1, std::memory_order_release);
      }
    });
  }
}

/// Take a chunk of a part, from its beginning or, of another thread's, from its end, and do it;
/// false if nothing is left.
bool Threads::do_chunk(Part& part, bool own) {
  std::uint64_t left = part.left.load(std::memory_order_relaxed);
  for (;;) {
    const std::uint64_t begin = left & index_mask, end = left >> index_bits;
    if (begin >= end) return false;
    const std::uint64_t size = std::min(chunk_, end - begin);
    const std::uint64_t rest = own ? packed(begin + size, end) : packed(begin, end - size);
    if (!part.left.compare_exchange_weak(left, rest, std::memory_order_relaxed)) continue;
    const std::uint64_t first = own ? begin : end - size;
    run_(context_, first, first + size);
    return true;
  }
}

void Threads::work(std::size_t self) {
  const std::size_t all = workers_.size() + 1;
  for (std::size_t k = 0; k < all; ++k)
    while (do_chunk(parts_[(self + k) % all], k == 0)) {
    }
}

void Threads::share_out(std::size_t n, Run run, void* context) {
  if (workers_.empty() || n == 1) return run(context, 0, n);
  const std::size_t all = workers_.size() + 1;
  // Eight chunks a thread: small enough to balance patches of different fill, large enough to stay
  // in step.
  chunk_ = std::max<std::size_t>(1, n / (8 * all));
  const auto start = [&](std::size_t k) { return n == balanced_ ? starts_[k] : k * n / all; };
  for (std::size_t k = 0; k < all; ++k)
    parts_[k].left.store(packed(start(k), start(k + 1)), std::memory_order_relaxed);
  run_ = run;
  context_ = context;
  running_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  work(0);
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
