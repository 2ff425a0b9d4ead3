#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "mpm/comm/comm.hpp"

namespace mpm {

/// Numbers that follow one another, as of the particles of a body: those that a rank takes.
struct Share {
  std::size_t first = 0, last = 0;  // up to the one before the last
  Share() = default;
  Share(std::size_t from, std::size_t to) : first(from), last(to) {}
  /// Of so many, one of equal parts.
  Share(std::size_t count, std::size_t part, std::size_t parts)
      : first(count * part / parts), last(count * (part + 1) / parts) {}
  /// The part of a rank if all get the same.
  Share(std::size_t count, const Comm& comm)
      : Share(count, static_cast<std::size_t>(comm.rank()), static_cast<std::size_t>(comm.size())) {
  }
  std::size_t count() const { return last - first; }
  bool holds(std::size_t number) const { return first <= number && number < last; }
  /// Its part of what is given for each particle, or what is given once for all: `width` numbers.
  std::vector<double> of(std::span<const double> given, std::size_t width) const {
    if (given.size() != width) given = given.subspan(first * width, count() * width);
    return {given.begin(), given.end()};
  }
};

}  // namespace mpm
