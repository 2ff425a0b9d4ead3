#pragma once
// The nodes that several patches hold, listed when the blocks are cut: a sum goes down the lists.
#include <vector>

#include "mpm/fields/memory_space.hpp"
#include "mpm/layout/block_shape.hpp"

namespace mpm {

/// Where a node is in the blocks of a patch and its neighbours.
template <int D>
struct SharedEntry {
  std::uint16_t neighbour : 5;  // whose block, by Tile<D>::offset
  std::uint16_t node : 11;      // its number there
  static_assert(Tile<D>::neighbours <= 32 && BlockShape<D>::nodes_max <= 2048);

  SharedEntry() = default;
  SharedEntry(int of_neighbour, int number)
      : neighbour(static_cast<std::uint16_t>(of_neighbour & 31)),
        node(static_cast<std::uint16_t>(number & 2047)) {}
};

/// Of the nodes that a patch owns, those that later patches hold too: a group of entries for each,
/// the patch's own, then the others' in the order of the tiles. Groups of two come first, then
/// those of three, and so on.
template <int D>
struct SharedNodes {
  static constexpr int most = power(2, D);  // patches that hold a node: two along each axis
  std::size_t first = 0;                    // entry, of all that the grid has
  std::uint32_t neighbours = 0;  // that there were when the nodes were listed, a bit each
  std::array<std::uint16_t, most + 1> groups{};  // how many have so many entries

  std::size_t entries() const {
    std::size_t n = 0;
    for (std::size_t m = 2; m <= most; ++m) n += m * groups[m];
    return n;
  }
};

/// The lists of all patches.
template <int D>
struct SharedLists {
  AlignedArray<SharedEntry<D>> entries;
  std::size_t used = 0;  // of them

  // Scratch, for each patch: its list is made anew, and where it was before.
  std::vector<std::uint8_t> outdated;
  std::vector<std::size_t> first_before;
  // Where the memory of the nodes lends too little: those that are kept have lists, and lend none.
  AlignedArray<std::byte> aside;
};

}  // namespace mpm
