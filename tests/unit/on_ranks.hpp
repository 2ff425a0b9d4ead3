#pragma once
#include <thread>

#include "mpm/comm/threads_comm.hpp"

namespace mpm::testing {

/// f(comm) in as many threads as there are ranks.
template <class F>
void on_ranks(int size, F&& f) {
  const auto world = std::make_shared<ThreadsWorld>(size);
  std::vector<std::jthread> threads;
  threads.reserve(static_cast<std::size_t>(size));
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&f, world, rank] {
      ThreadsComm comm(world, rank);
      f(comm);
    });
}

}  // namespace mpm::testing
