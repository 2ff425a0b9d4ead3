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
  /// bytes have. Both stay as they are until finish().
  virtual void start(Mail& mail) = 0;
  /// Wait until all that was started has been sent and received.
  virtual void finish(Mail& mail) = 0;
  /// Send `out` to whom nobody knows of, and replace `in` by what has come, by rank.
  virtual void exchange(Mail& mail) = 0;
  /// Say that this rank cannot go on: the others get RankFailed from what they wait in.
  virtual void fail(const std::string& why) = 0;

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
  void exchange(Mail& mail) override { mail.in.clear(); }
  void fail(const std::string&) override {}
};

}  // namespace mpm
