#pragma once
// Ctrl-C, SIGTERM and their like while the core runs without the interpreter's lock.
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

#if defined(__linux__)
#include <sys/syscall.h>
#include <unistd.h>
#else
#include <pthread.h>
#endif

namespace mpm::bindings {

/// While it lives, the signals that end a run set a flag that a loop can look at, before Python
/// takes notice of them as always. In the main thread only, where Python handles them, and only
/// those that it does handle. Asking Python itself needs its lock, for which a loop would have to
/// wait.
class InterruptFlag {
 public:
  InterruptFlag() {
    if (!in_main_thread()) return;  // The flag is the main thread's.
    raised().store(false);
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      struct sigaction& old = olds()[k];
      if (sigaction(kinds[k], nullptr, &old) != 0) continue;
      if (old.sa_handler == SIG_DFL || old.sa_handler == SIG_IGN ||
          (old.sa_flags & SA_SIGINFO) != 0)
        continue;
      struct sigaction ours = old;
      ours.sa_handler = note;
      installed_[k] = sigaction(kinds[k], &ours, nullptr) == 0;
    }
  }
  ~InterruptFlag() {
    for (std::size_t k = 0; k < kinds.size(); ++k)
      if (installed_[k]) sigaction(kinds[k], &olds()[k], nullptr);
  }
  InterruptFlag(const InterruptFlag&) = delete;
  InterruptFlag& operator=(const InterruptFlag&) = delete;

  const std::atomic<bool>* get() const { return in_main_thread() ? &raised() : nullptr; }

 private:
  /// As `base/signals.py` has them.
  static constexpr std::array kinds{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU};
  using Actions = std::array<struct sigaction, kinds.size()>;

  static std::atomic<bool>& raised() {
    static std::atomic<bool> flag{false};
    static_assert(std::atomic<bool>::is_always_lock_free);  // So that a signal may set it.
    return flag;
  }
  static Actions& olds() {
    static Actions found{};
    return found;
  }
  static void note(int kind) {
    raised().store(true);
    for (std::size_t k = 0; k < kinds.size(); ++k)
      if (kinds[k] == kind) olds()[k].sa_handler(kind);
  }
  static bool in_main_thread() {
#if defined(__linux__)
    return syscall(SYS_gettid) == getpid();
#else
    return pthread_main_np() != 0;
#endif
  }

  std::array<bool, kinds.size()> installed_{};
};

}  // namespace mpm::bindings
