#pragma once
// A pool of threads that share out a range of patches. No result may depend on who did which.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace mpm {

class Threads {
 public:
  explicit Threads(int count = 1) { resize(count); }
  ~Threads() { stop(); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  int count() const { return static_cast<int>(workers_.size()) + 1; }
  void resize(int count);

  /// body(i) for every i in [0, n), n below 2^32. Each thread begins with its own part of the
  /// range, the same for the same n, so that what it works on stays in its cache; one that is idle
  /// takes chunks from the ends of others' parts. The caller works too. Nothing is allocated.
  template <class Body>
  void for_each(std::size_t n, Body&& body) {
    if (n == 0) return;
    auto run = [](void* context, std::size_t begin, std::size_t end) {
      auto& f = *static_cast<std::remove_reference_t<Body>*>(context);
      for (std::size_t i = begin; i < end; ++i) f(i);
    };
    // Never inlined here: a second copy of the body for one thread might be compiled to other
    // roundings.
    share_out(n, run, &body);
  }

  /// From now on the parts of ranges of n are of equal cost, not of equal length; cost(i) >= 0.
  template <class F>
  void balance(std::size_t n, F&& cost) {
    if (workers_.empty()) return;
    double total = 0.0, so_far = 0.0;
    for (std::size_t i = 0; i < n; ++i) total += cost(i);
    balanced_ = n;
    std::size_t i = 0;
    for (std::size_t k = 0; k < starts_.size(); ++k) {
      const double wanted = total * static_cast<double>(k) / static_cast<double>(count());
      for (; i < n && so_far < wanted; ++i) so_far += cost(i);
      starts_[k] = k + 1 < starts_.size() ? i : n;
    }
  }

 private:
  using Run = void (*)(void*, std::size_t, std::size_t);
  /// What is left of a thread's part of the range: first index, and the one behind the last, in the
  /// lower and the upper half.
  struct alignas(64) Part {
    std::atomic<std::uint64_t> left{0};
  };
  void share_out(std::size_t n, Run run, void* context);
  void work(std::size_t self);
  bool do_chunk(Part& part, bool own);
  void stop();

  std::vector<std::thread> workers_;
  std::unique_ptr<Part[]> parts_;      // one for each thread, the caller's first
  std::atomic<std::uint64_t> job_{0};  // number of the job posted last
  std::atomic<int> running_{0};        // workers still in the job
  std::atomic<bool> stopping_{false};
  std::uint64_t chunk_ = 1;
  std::size_t balanced_ = 0;         // length of the ranges that are balanced
  std::vector<std::size_t> starts_;  // where their parts begin, and their end
  Run run_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace mpm
