#pragma once
// The nodes that several patches hold, listed when the blocks are cut: a sum goes down the lists.
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

/// The list of one patch, while it is made.
template <int D>
class SharedList {
 public:
  /// Another patch holds a node of this one.
  void add(int node, SharedEntry<D> other) {
    const auto n = static_cast<std::size_t>(node);
    others_[n][count_[n]++] = other;
  }
  /// Count the groups.
  void count(int nodes, SharedNodes<D>& shared) const {
    shared.groups.fill(0);
    for (int n = 0; n < nodes; ++n)
      if (const std::uint8_t others = count_[static_cast<std::size_t>(n)])
        ++shared.groups[others + std::size_t{1}];
  }
  void write(int nodes, const SharedNodes<D>& shared, SharedEntry<D>* to) const {
    std::array<SharedEntry<D>*, SharedNodes<D>::most + 1> next{};
    for (std::size_t m = 2; m < next.size(); ++m) {
      next[m] = to;
      to += m * shared.groups[m];
    }
    for (int node = 0; node < nodes; ++node) {
      const auto n = static_cast<std::size_t>(node);
      if (count_[n] == 0) continue;
      SharedEntry<D>*& at = next[count_[n] + std::size_t{1}];
      *at++ = SharedEntry<D>(Tile<D>::self, node);
      at = std::copy_n(others_[n].begin(), count_[n], at);
    }
  }

 private:
  static constexpr std::size_t nodes_max = BlockShape<D>::nodes_max;
  std::array<std::uint8_t, nodes_max> count_{};
  std::array<std::array<SharedEntry<D>, SharedNodes<D>::most - 1>, nodes_max> others_;
};

}  // namespace mpm
