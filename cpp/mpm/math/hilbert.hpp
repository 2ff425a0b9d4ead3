#pragma once
// The Hilbert curve: places that follow one another along it lie side by side, so that a range of
// it is a compact region.
#include <array>
#include <cstddef>
#include <cstdint>

namespace mpm {

/// The number along the curve of a place with `bits` bits an axis (Skilling 2004, "Programming the
/// Hilbert curve").
template <std::size_t D>
std::uint64_t hilbert_number(std::array<std::uint32_t, D> x, int bits) {
  const std::uint32_t highest = std::uint32_t{1} << (bits - 1);
  // Undo the turns and reflections of the cubes, from the largest to the smallest.
  for (std::uint32_t bit = highest; bit > 1; bit >>= 1)
    for (std::size_t a = 0; a < D; ++a) {
      const std::uint32_t below = bit - 1, swapped = (x[0] ^ x[a]) & below;
      x[0] ^= x[a] & bit ? below : swapped;
      x[a] ^= x[a] & bit ? 0 : swapped;
    }
  // To the Gray code.
  for (std::size_t a = 1; a < D; ++a) x[a] ^= x[a - 1];
  std::uint32_t turned = 0;
  for (std::uint32_t bit = highest; bit > 1; bit >>= 1)
    if (x[D - 1] & bit) turned ^= bit - 1;
  std::uint64_t number = 0;
  for (std::uint32_t bit = highest; bit > 0; bit >>= 1)
    for (std::size_t a = 0; a < D; ++a) number = number << 1 | ((x[a] ^ turned) & bit ? 1 : 0);
  return number;
}

}  // namespace mpm
