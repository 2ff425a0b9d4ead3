#pragma once
// What bodies that touch do to each other along the normal.
#include <cstdint>

#include "mpm/catalogue/words.hpp"

namespace mpm {

enum class Response : std::uint8_t { impulses, springs };
template <>
inline constexpr auto words<Response> = std::to_array<Word<Response>>(
    {{"impulses", Response::impulses, "approach is stopped at the nodes, eqs. (6)-(7), (13)"},
     {"springs", Response::springs, "particles push a body whose surface they overlap"}});

}  // namespace mpm
