#pragma once
// What bodies that touch do to each other along the normal.
#include <cstdint>

#include "mpm/catalogue/words.hpp"
#include "mpm/particles/body.hpp"

namespace mpm {

enum class Response : std::uint8_t { impulses, springs, by_matter };
template <>
inline constexpr auto words<Response> = std::to_array<Word<Response>>(
    {{"impulses", Response::impulses, "approach is stopped at the nodes, eqs. (6)-(7), (13)"},
     {"springs", Response::springs, "particles push a body whose surface they overlap"},
     {"by_matter", Response::by_matter,
      "impulses where one is a gas or an explosive, or both are liquids; else springs"}});

/// Do particles push any bodies by springs?
constexpr bool may_spring(Response response) { return response != Response::impulses; }
/// Is the approach of two bodies stopped at the nodes? By matter it is where particles of a gas
/// meet others, or liquids each other: no surface stays the same there, and springs would make
/// energy.
constexpr bool stops_approach(Response response, Matter a, Matter b) {
  if (response != Response::by_matter) return response == Response::impulses;
  return a == Matter::gas || b == Matter::gas || (a == Matter::liquid && b == Matter::liquid);
}

}  // namespace mpm
