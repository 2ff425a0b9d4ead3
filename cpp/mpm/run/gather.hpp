#pragma once
#include "mpm/comm/letters.hpp"

namespace mpm {

/// Numbers of which each rank has some, to rank 0. for_each_place(f) calls f(k) for the places of
/// those that this rank has. By all ranks at once; others than rank 0 keep what they have.
template <class Number, class ForEachPlace>
void gather(Comm& comm, std::span<Number> numbers, ForEachPlace&& for_each_place) {
  if (comm.alone()) return;
  Mail mail;
  if (comm.rank() != 0) {
    Letter& letter = letter_to(mail, 0);
    for_each_place([&](std::size_t k) {
      write(letter, k);
      write(letter, numbers[k]);
    });
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      const auto k = reader.read<std::size_t>();
      numbers[k] = reader.read<Number>();
    }
}

}  // namespace mpm
