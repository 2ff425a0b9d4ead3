#pragma once
// Ranks: those who work on one simulation, each on its own particles, and what passes between them.
// The core knows no more of it than this; who carries the letters, as threads of one process
// (threads_comm.hpp), is a class of its own.
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace mpm {

/// Bytes to or from a rank.
struct Letter {
  int rank = 0;
  std::vector<std::byte> bytes;
};

/// Letters to others and those that come. At most one to and one from each rank; none to oneself.
struct Mail {
  std::vector<Letter> out, in;
};

/// What a rank has sent, and the time that it was in the functions of its Comm, waiting included.
struct Traffic {
  std::int64_t letters = 0, bytes = 0;
  std::int64_t exchanges = 0, reductions = 0;  // in which all ranks wait for all
  double seconds = 0.0;

  /// f(here, there) for each number.
  template <class F>
  static void for_each(Traffic& here, const Traffic& there, F&& f) {
    f(here.letters, there.letters);
    f(here.bytes, there.bytes);
    f(here.exchanges, there.exchanges);
    f(here.reductions, there.reductions);
    f(here.seconds, there.seconds);
  }
  Traffic& operator+=(const Traffic& other) {
    for_each(*this, other, [](auto& x, auto y) { x += y; });
    return *this;
  }
  Traffic operator-(const Traffic& other) const {
    Traffic rest = *this;
    for_each(rest, other, [](auto& x, auto y) { x -= y; });
    return rest;
  }
};

/// Another rank has failed, and with it the run.
struct RankFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// All functions but rank(), size() and fail() are called by all ranks, in the same order.
class Comm {
 public:
  virtual ~Comm() = default;
  Comm() = default;
  Comm(const Comm&) = delete;
  Comm& operator=(const Comm&) = delete;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Of each number the largest of all ranks.
  virtual void all_max(std::span<double> numbers) = 0;
  /// Of each integer the sum over all ranks.
  virtual void all_sum(std::span<std::int64_t> numbers) = 0;
  /// Start to send `out`, and to receive `in` from the ranks named there, of the lengths that its
  /// bytes have. Both stay as they are: `in` until finish(), `out` until release().
  virtual void start(Mail& mail) = 0;
  /// Wait until all that was started has been received.
  virtual void finish(Mail& mail) = 0;
  /// Wait until all that was started has been sent, which others may have to ask for: it costs
  /// least before the next start().
  virtual void release(Mail& mail) = 0;
  /// Send `out` to whom nobody knows of, and replace `in` by what has come, by rank.
  virtual void exchange(Mail& mail) = 0;
  /// Say that this rank cannot go on: the others get RankFailed from what they wait in.
  virtual void fail(const std::string& why) = 0;

  /// So far, where it is counted (counted_comm.hpp).
  virtual Traffic traffic() const { return {}; }

  bool alone() const { return size() == 1; }
};

/// A run that no others work on.
class NoOthers final : public Comm {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void all_max(std::span<double>) override {}
  void all_sum(std::span<std::int64_t>) override {}
  void start(Mail&) override {}
  void finish(Mail&) override {}
  void release(Mail&) override {}
  void exchange(Mail& mail) override { mail.in.clear(); }
  void fail(const std::string&) override {}
};

}  // namespace mpm
