#pragma once
// Some lanes of a register, stored one after another.
#include <array>
#include <bit>

#include "mpm/math/batch.hpp"

namespace mpm {

#if defined(__AVX2__) && !defined(__AVX512VL__)
/// For each set of four lanes, the halves of a register that bring them to its front.
inline constexpr auto halves_of_chosen = [] {
  std::array<std::array<std::int32_t, 8>, 16> table{};
  for (std::size_t lanes = 0; lanes < table.size(); ++lanes) {
    std::size_t next = 0;
    for (std::int32_t lane = 0; lane < 4; ++lane)
      if (lanes >> lane & 1u) {
        table[lanes][next++] = 2 * lane;
        table[lanes][next++] = 2 * lane + 1;
      }
  }
  return table;
}();
#endif

/// Store the lanes whose bits are set one after another; what is behind them, up to W numbers in
/// all, may be overwritten.
template <int W>
void store_chosen(double* to, Batch<W> a, std::uint64_t lanes) {
#if defined(__AVX512VL__)
  const auto chosen = static_cast<__mmask8>(lanes);
  if constexpr (W == 8) return Batch<W>(_mm512_maskz_compress_pd(chosen, a.v)).store(to);
  if constexpr (W == 4) return Batch<W>(_mm256_maskz_compress_pd(chosen, a.v)).store(to);
#elif defined(__AVX2__)
  if constexpr (W == 4) {
    const auto* const halves = halves_of_chosen[lanes].data();
    const __m256i places = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(halves));
    const auto packed = _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(a.v), places);
    return Batch<W>(reinterpret_cast<typename Batch<W>::Vector>(packed)).store(to);
  }
#endif
  if constexpr (W == 2) {
    const Batch<W> second(__builtin_shufflevector(a.v, a.v, 1, 1));
    return (lanes == 2 ? second : a).store(to);
  }
  for (; lanes != 0; lanes &= lanes - 1) *to++ = a[std::countr_zero(lanes)];
}

}  // namespace mpm
