#pragma once
// Loops of a fixed number of turns, written out.
#include <type_traits>
#include <utility>

/// For lambdas in the innermost loops: g++ leaves some of them as calls, with what they capture in
/// memory.
#define MPM_INLINE __attribute__((always_inline))

namespace mpm {

/// f(0), f(1) ... f(N - 1), written out; the numbers are constants.
template <int N, class F>
[[gnu::always_inline]] inline void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) MPM_INLINE {
    (f(std::integral_constant<int, k>{}), ...);
  }(std::make_integer_sequence<int, N>{});
}

}  // namespace mpm
