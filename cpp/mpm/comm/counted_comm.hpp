#pragma once
// What passes between ranks, counted, and the time that it takes.
#include <chrono>
#include <memory>
#include <utility>

#include "mpm/comm/comm.hpp"

namespace mpm {

/// Passes everything on to another.
class CountedComm final : public Comm {
 public:
  explicit CountedComm(std::shared_ptr<Comm> to) : to_(std::move(to)) {}
  int rank() const override { return to_->rank(); }
  int size() const override { return to_->size(); }
  void all_max(std::span<double> numbers) override {
    ++traffic_.reductions;
    timed([&] { to_->all_max(numbers); });
  }
  void all_sum(std::span<std::int64_t> numbers) override {
    ++traffic_.reductions;
    timed([&] { to_->all_sum(numbers); });
  }
  void start(Mail& mail) override {
    count(mail);
    timed([&] { to_->start(mail); });
  }
  void finish(Mail& mail) override {
    timed([&] { to_->finish(mail); });
  }
  void release(Mail& mail) override {
    timed([&] { to_->release(mail); });
  }
  void exchange(Mail& mail) override {
    count(mail);
    ++traffic_.exchanges;
    timed([&] { to_->exchange(mail); });
  }
  void fail(const std::string& why) override { to_->fail(why); }
  Traffic traffic() const override { return traffic_; }

 private:
  void count(const Mail& mail) {
    traffic_.letters += static_cast<std::int64_t>(mail.out.size());
    for (const Letter& letter : mail.out)
      traffic_.bytes += static_cast<std::int64_t>(letter.bytes.size());
  }
  template <class F>
  void timed(F&& f) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    traffic_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  std::shared_ptr<Comm> to_;
  Traffic traffic_;
};

}  // namespace mpm
