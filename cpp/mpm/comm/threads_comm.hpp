#pragma once
// Ranks that are threads of one process: what a debugger, a sanitizer and a test without MPI see.
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "mpm/comm/comm.hpp"

namespace mpm {

/// What the threads share.
class ThreadsWorld {
 public:
  explicit ThreadsWorld(int size);
  int size() const { return size_; }
  /// After all ranks have failed alike and wait for nothing: begin anew.
  void recover();

 private:
  friend class ThreadsComm;
  struct Sent {
    std::uint64_t call;  // of the sender, by which a letter is known
    std::vector<std::byte> bytes;
  };
  /// Wait until `ready()`; throws RankFailed once any rank has failed.
  template <class Ready>
  void wait(std::unique_lock<std::mutex>& lock, Ready&& ready);
  /// Combine numbers of all ranks, one after another; all get the result once the last has come.
  template <class Number, class Combine>
  void reduce(std::vector<Number>& shared, std::span<Number> numbers, Combine&& combine);
  std::deque<Sent>& box(int from, int to) {
    return boxes_[static_cast<std::size_t>(from) * static_cast<std::size_t>(size_) +
                  static_cast<std::size_t>(to)];
  }

  int size_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::deque<Sent>> boxes_;  // by sender and receiver
  std::vector<double> largest_;
  std::vector<std::int64_t> sums_;
  int entered_ = 0, left_ = 0;  // ranks that have given their numbers; that have taken the result
  bool failed_ = false;
  std::string why_;
};

/// One of the ranks of a world.
class ThreadsComm final : public Comm {
 public:
  ThreadsComm(std::shared_ptr<ThreadsWorld> world, int rank)
      : world_(std::move(world)), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return world_->size(); }
  void all_max(std::span<double> numbers) override;
  void all_sum(std::span<std::int64_t> numbers) override;
  void start(Mail& mail) override;
  void finish(Mail& mail) override;
  void release(Mail&) override {}  // send() has copied it
  void exchange(Mail& mail) override;
  void fail(const std::string& why) override;

 private:
  void send(const Mail& mail);

  std::shared_ptr<ThreadsWorld> world_;
  int rank_;
  std::uint64_t call_ = 0;  // number of the last start() or exchange()
};

}  // namespace mpm
