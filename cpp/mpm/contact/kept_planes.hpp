#pragma once
// What is cached of tiles from step to step, apart from where it lies: it goes to the rank that
// gets a tile, and into a checkpoint.
#include "mpm/contact/contact.hpp"

namespace mpm {

/// The cached nodes of a tile, in the order of its bits, and their pairs one behind another.
template <int D>
struct KeptTile {
  Index<D> tile{};
  std::uint64_t cached = 0;  // which nodes, by Tile<D>::cell
  std::vector<CachedNode> nodes;
  std::vector<CachedPair<D>> pairs;
};

/// Those of this rank.
template <int D>
std::vector<KeptTile<D>> kept_tiles(const Contact<D>& contact);

/// Cache them, and nothing else, in the tiles that there are.
template <int D>
void keep_tiles(Contact<D>& contact, const std::vector<KeptTile<D>>& kept);

/// Those that the rank of each tile has, of all ranks, to those that have them now; or all to rank
/// 0, by their tiles. By all ranks at once.
template <int D>
std::vector<KeptTile<D>> exchange_kept(const std::vector<KeptTile<D>>& kept,
                                       const Partition<D>& partition, bool to_first);

}  // namespace mpm
