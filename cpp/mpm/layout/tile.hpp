#pragma once
// The tile: 4 x 4 x 4 cells in 3D, 8 x 8 in 2D, 64 cells either way; its 3^D - 1 neighbours.
#include <array>
#include <cstdint>

namespace mpm {

/// A point of an unbounded integer lattice: a cell, a node or a tile.
template <int D>
using Index = std::array<std::int32_t, D>;

constexpr int power(int base, int exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/// f(index) for every point of a box, its ends included, the first axis fastest.
template <int D, class F>
void for_each_index(const Index<D>& low, const Index<D>& high, F&& f) {
  Index<D> i = low;
  for (i[D - 1] = low[D - 1]; i[D - 1] <= high[D - 1]; ++i[D - 1])
    for (i[D - 2] = low[D - 2]; i[D - 2] <= high[D - 2]; ++i[D - 2]) {
      if constexpr (D == 2)
        f(i);
      else
        for (i[0] = low[0]; i[0] <= high[0]; ++i[0]) f(i);
    }
}

template <int D>
struct Tile {
  static constexpr int cells = D == 3 ? 4 : 8;  // along an edge
  static constexpr int cell_count = power(cells, D);
  static constexpr int corners = power(2, D);
  static constexpr int neighbours = power(3, D);  // the tile itself included, in the middle
  static constexpr int self = neighbours / 2;

  static constexpr int cell(const Index<D>& i) {
    int n = 0;
    for (int a = D - 1; a >= 0; --a) n = n * cells + i[a];
    return n;
  }
  static constexpr Index<D> cell_index(int n) {
    Index<D> i{};
    for (int a = 0; a < D; ++a, n /= cells) i[a] = n % cells;
    return i;
  }
  /// Neighbour k of a tile.
  static constexpr Index<D> beside(Index<D> tile, int k) {
    for (std::size_t a = 0; a < D; ++a) tile[a] += offset(k)[a];
    return tile;
  }
  /// The cells with coordinate i along an axis, a bit each.
  static constexpr std::uint64_t slice(std::size_t axis, int i) {
    constexpr std::array<std::uint64_t, 3> first =
        D == 3 ? std::array<std::uint64_t, 3>{0x1111111111111111, 0x000F000F000F000F, 0xFFFF}
               : std::array<std::uint64_t, 3>{0x0101010101010101, 0xFF};
    return first[axis] << i * power(cells, static_cast<int>(axis));
  }
  /// Cells, a bit each, moved by so many along an axis; those that leave the tile are dropped.
  static constexpr std::uint64_t moved(std::uint64_t set, std::size_t axis, int by) {
    if (by <= -cells || by >= cells) return 0;
    const int bits = by * power(cells, static_cast<int>(axis));
    // What would leave the tile is cut off before, else it would come back in as the next row.
#if defined(__CUDA_ARCH__)
    set &= staying(axis, by);  // a device reads no table of the host's
#else
    set &= stay[axis][static_cast<std::size_t>(by + cells)];
#endif
    return bits < 0 ? set >> -bits : set << bits;
  }
  /// Offset -1, 0, 1 along each axis of neighbour k, and back. Neighbours are numbered in the order
  /// of the tiles.
  static constexpr Index<D> offset(int k) {
    Index<D> o{};
    for (int a = 0; a < D; ++a, k /= 3) o[a] = k % 3 - 1;
    return o;
  }
  static constexpr int neighbour(const Index<D>& o) {
    int k = 0;
    for (int a = D - 1; a >= 0; --a) k = 3 * k + o[a] + 1;
    return k;
  }
  /// Offset 0 or 1 along each axis of corner k of a cell.
  static constexpr Index<D> corner(int k) {
    Index<D> o{};
    for (int a = 0; a < D; ++a, k /= 2) o[a] = k % 2;
    return o;
  }

 private:
  /// The cells that stay in the tile when they move by so many along an axis.
  static constexpr std::uint64_t staying(std::size_t axis, int by) {
    std::uint64_t kept = 0;
    for (int i = 0; i < cells; ++i)
      if (i + by >= 0 && i + by < cells) kept |= slice(axis, i);
    return kept;
  }
  /// The same for -cells to cells.
  static constexpr auto stay = [] {
    std::array<std::array<std::uint64_t, 2 * cells + 1>, D> kept{};
    for (std::size_t a = 0; a < D; ++a)
      for (int by = -cells; by <= cells; ++by)
        kept[a][static_cast<std::size_t>(by + cells)] = staying(a, by);
    return kept;
  }();
};

/// The order of tiles: the last axis counts most. Sums over tiles are taken in it.
template <int D>
constexpr bool tile_less(const Index<D>& x, const Index<D>& y) {
  for (int a = D - 1; a >= 0; --a)
    if (x[a] != y[a]) return x[a] < y[a];
  return false;
}

}  // namespace mpm
