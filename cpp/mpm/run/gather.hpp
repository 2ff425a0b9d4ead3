#pragma once
#include "mpm/comm/letters.hpp"

namespace mpm {

/// Numbers of which each rank has some, to rank 0: for_each(f) calls f(k, number) for those that
/// this rank has, and rank 0 gets each as its k-th. By all ranks at once; others than rank 0 need
/// no room.
template <class Number, class ForEach>
void gather(Comm& comm, std::span<Number> to, ForEach&& for_each) {
  Mail mail;
  if (comm.rank() == 0) {
    for_each([&](std::size_t k, const Number& number) { to[k] = number; });
  } else {
    Letter& letter = letter_to(mail, 0);
    for_each([&](std::size_t k, const Number& number) {
      write(letter, k);
      write(letter, number);
    });
  }
  if (comm.alone()) return;
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      const auto k = reader.read<std::size_t>();
      to[k] = reader.read<Number>();
    }
}

}  // namespace mpm
