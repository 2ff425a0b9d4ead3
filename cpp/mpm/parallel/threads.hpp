#pragma once
// A pool of threads that share out a range of patches. No result may depend on who did which.
#include <atomic>
#include <cstdint>
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

  /// body(i) for every i in [0, n), in chunks that idle threads take. The caller works too. Nothing
  /// is allocated.
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

 private:
  using Run = void (*)(void*, std::size_t, std::size_t);
  void share_out(std::size_t n, Run run, void* context);
  void work();
  void stop();

  std::vector<std::thread> workers_;
  std::atomic<std::uint64_t> job_{0};  // number of the job posted last
  std::atomic<std::size_t> next_{0};   // first index not yet taken
  std::atomic<int> running_{0};        // workers still in the job
  std::atomic<bool> stopping_{false};
  std::size_t total_ = 0, chunk_ = 1;
  Run run_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace mpm
