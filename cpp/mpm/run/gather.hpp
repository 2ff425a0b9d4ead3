#pragma once
#include "mpm/comm/letters.hpp"
#include "mpm/run/slices.hpp"

namespace mpm {

/// Numbers of which each rank has some, to those that get them: for_each(f) calls
/// f(row, place, number) for those that this rank has, and who gets the slice with the row finds
/// each at to[(row - first of the slice) * width + place]. By all ranks at once; those without a
/// slice need no room.
template <class Number, class ForEach>
void gather(Comm& comm, const Slices& slices, std::size_t width, std::span<Number> to,
            ForEach&& for_each) {
  const Share own = slices.of(comm.rank());
  std::vector<Letter> letters(slices.size());
  for_each([&](std::size_t row, std::size_t place, const Number& number) {
    if (own.holds(row)) {
      to[(row - own.first) * width + place] = number;
      return;
    }
    const std::size_t slice = slices.slice_with(row);
    write(letters[slice], (row - slices.rows(slice).first) * width + place);
    write(letters[slice], number);
  });
  if (comm.alone()) return;
  Mail mail;
  for (std::size_t slice = 0; slice < letters.size(); ++slice) {
    if (letters[slice].bytes.empty()) continue;
    letters[slice].rank = slices.rank(slice);
    mail.out.push_back(std::move(letters[slice]));
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      const auto k = reader.read<std::size_t>();
      to[k] = reader.read<Number>();
    }
}

}  // namespace mpm
