#pragma once
// What bodies that touch do to each other along the normal.
#include <cstdint>

#include "mpm/catalogue/words.hpp"

namespace mpm {

enum class Response : std::uint8_t { impulses, springs, by_matter };
template <>
inline constexpr auto words<Response> = std::to_array<Word<Response>>(
    {{"impulses", Response::impulses, "approach is stopped at the nodes, eqs. (6)-(7), (13)"},
     {"springs", Response::springs, "particles push a body whose surface they overlap"},
     {"by_matter", Response::by_matter,
      "springs between bodies that have a surface, impulses where one of the two flows: a gas, a "
      "liquid, an explosive"}});

/// Do particles push any bodies by springs?
constexpr bool may_spring(Response response) { return response != Response::impulses; }
/// Is the approach of two bodies stopped at the nodes? `flows`: has one of them no shape of its
/// own?
constexpr bool stops_approach(Response response, bool flows) {
  return response == Response::impulses || (response == Response::by_matter && flows);
}

}  // namespace mpm
