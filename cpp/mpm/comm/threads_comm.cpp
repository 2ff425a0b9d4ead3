#include "mpm/comm/threads_comm.hpp"

#include <algorithm>
#include <utility>

namespace mpm {

ThreadsWorld::ThreadsWorld(int size)
    : size_(size), boxes_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}

void ThreadsWorld::recover() {
  failed_ = false;
  entered_ = left_ = 0;
  for (auto& box : boxes_) box.clear();
}

template <class Ready>
void ThreadsWorld::wait(std::unique_lock<std::mutex>& lock, Ready&& ready) {
  changed_.wait(lock, [&] { return failed_ || ready(); });
  if (!ready()) throw RankFailed(why_);
}

template <class Number, class Combine>
void ThreadsWorld::reduce(std::vector<Number>& shared, std::span<Number> numbers,
                          Combine&& combine) {
  std::unique_lock lock(mutex_);
  // Nobody begins the next one before all have the result of the last.
  wait(lock, [&] { return left_ == 0; });
  if (entered_ == 0)
    shared.assign(numbers.begin(), numbers.end());
  else if (shared.size() != numbers.size())
    throw std::logic_error("ranks do not agree on what they sum");
  else
    for (std::size_t k = 0; k < numbers.size(); ++k) shared[k] = combine(shared[k], numbers[k]);
  if (++entered_ == size_) changed_.notify_all();
  wait(lock, [&] { return entered_ == size_; });
  std::ranges::copy(shared, numbers.begin());
  if (++left_ < size_) return;
  entered_ = left_ = 0;
  changed_.notify_all();
}

void ThreadsComm::all_max(std::span<double> numbers) {
  // No number counts as the largest, so that one who has some is heard.
  world_->reduce(world_->largest_, numbers,
                 [](double x, double y) { return x >= y || x != x ? x : y; });
}

void ThreadsComm::all_sum(std::span<std::int64_t> numbers) {
  world_->reduce(world_->sums_, numbers, std::plus<>());
}

void ThreadsComm::send(const Mail& mail) {
  ++call_;
  {
    const std::lock_guard lock(world_->mutex_);
    for (const Letter& letter : mail.out)
      world_->box(rank_, letter.rank).push_back({call_, letter.bytes});
  }
  world_->changed_.notify_all();
}

void ThreadsComm::start(Mail& mail) { send(mail); }

void ThreadsComm::finish(Mail& mail) {
  std::unique_lock lock(world_->mutex_);
  for (Letter& letter : mail.in) {
    auto& box = world_->box(letter.rank, rank_);
    world_->wait(lock, [&] { return !box.empty(); });
    if (box.front().bytes.size() != letter.bytes.size())
      throw std::logic_error("a letter has another length than was agreed");
    letter.bytes = std::move(box.front().bytes);
    box.pop_front();
  }
}

void ThreadsComm::exchange(Mail& mail) {
  send(mail);
  // All have sent when the sum is known.
  std::int64_t none = 0;
  all_sum({&none, 1});
  mail.in.clear();
  const std::lock_guard lock(world_->mutex_);
  for (int from = 0; from < size(); ++from) {
    auto& box = world_->box(from, rank_);
    // Else it is of a later call.
    if (box.empty() || box.front().call != call_) continue;
    mail.in.push_back({from, std::move(box.front().bytes)});
    box.pop_front();
  }
}

void ThreadsComm::fail(const std::string& why) {
  {
    const std::lock_guard lock(world_->mutex_);
    if (!std::exchange(world_->failed_, true)) world_->why_ = why;
  }
  world_->changed_.notify_all();
}

}  // namespace mpm
