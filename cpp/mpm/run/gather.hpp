#pragma once
#include "mpm/comm/letters.hpp"
#include "mpm/run/slices.hpp"

namespace mpm {

/// Components of rows of which each rank has some, to those that get the rows: for_each(f) calls
/// f(row, component, number) for those that this rank has, one component after another and the rows
/// each time in the same order. Who gets the slice with the row finds a number at
/// to[(row - first of the slice) * width + places[component]]. By all ranks at once; those without
/// a slice need no room.
template <class Number, class ForEach>
void gather(Comm& comm, const Slices& slices, std::size_t width, std::span<const int> places,
            std::span<Number> to, ForEach&& for_each) {
  struct ToSlice {
    std::vector<std::uint32_t> rows;  // from the first of the slice
    std::vector<Number> numbers;      // a component of all these rows after another
  };
  const Share own = slices.of(comm.rank());
  const auto put = [&](std::size_t row, std::size_t component, const Number& number) {
    to[row * width + static_cast<std::size_t>(places[component])] = number;
  };
  std::vector<ToSlice> out(slices.size());
  for_each([&](std::size_t row, std::size_t component, const Number& number) {
    if (own.holds(row)) {
      put(row - own.first, component, number);
      return;
    }
    const std::size_t slice = slices.slice_with(row);
    if (component == 0)
      out[slice].rows.push_back(static_cast<std::uint32_t>(row - slices.rows(slice).first));
    out[slice].numbers.push_back(number);
  });
  if (comm.alone()) return;
  Mail mail;
  for (std::size_t slice = 0; slice < out.size(); ++slice) {
    if (out[slice].rows.empty()) continue;
    mail.out.push_back({slices.rank(slice), {}});
    Letter& letter = mail.out.back();
    write(letter, out[slice].rows.size());
    write_all<std::uint32_t>(letter, out[slice].rows);
    write_all<Number>(letter, out[slice].numbers);
    out[slice] = {};
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in) {
    Reader reader(letter);
    std::vector<std::uint32_t> rows(reader.read<std::size_t>());
    for (std::uint32_t& row : rows) row = reader.read<std::uint32_t>();
    for (std::size_t component = 0; component < places.size(); ++component)
      for (const std::uint32_t row : rows) put(row, component, reader.read<Number>());
  }
}

}  // namespace mpm
