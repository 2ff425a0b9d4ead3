#pragma once
// Loops of a fixed number of turns, written out.
#include <type_traits>
#include <utility>

#include "mpm/math/host_device.hpp"

namespace mpm {

/// f(0), f(1) ... f(N - 1), written out; the numbers are constants.
template <int N, class F>
MPM_HD MPM_INLINE inline void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) MPM_INLINE {
    (f(std::integral_constant<int, k>{}), ...);
  }(std::make_integer_sequence<int, N>{});
}

}  // namespace mpm
