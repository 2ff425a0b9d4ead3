#pragma once
// Which patches have a tile's nodes in their blocks, and at which of them their bodies have mass.
#include <cstdint>

#include "mpm/grid/tile_grid.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {

/// A patch whose block may have nodes that belong to a tile: the tile's own patch of a body, or one
/// beside it, as far as its cells go now. (A tile's own nodes are all but those at its upper ends,
/// which are the next tile's first.)
struct TileHolder {
  std::int32_t body;
  std::uint32_t patch : 27;
  std::uint32_t neighbour : 5;  // where the tile lies as seen from the patch: Tile<D>::offset

  static constexpr std::size_t patches_max = std::size_t{1} << 27;

  TileHolder(int of_body, std::size_t number, int tile)
      : body(of_body),
        patch(static_cast<std::uint32_t>(number) & (patches_max - 1)),
        neighbour(static_cast<std::uint32_t>(tile) & 31u) {}
};

template <int D>
const BlockShape<D>& shape_of(const TileGrid<D>& grid, const TileHolder& holder) {
  return grid.patches[static_cast<std::size_t>(holder.patch)].shape;
}
/// Coordinate in a holder's block of a node of the tile.
template <int D>
Index<D> seen_from(const TileHolder& holder, Index<D> node) {
  const Index<D> o = Tile<D>::offset(holder.neighbour);
  for (std::size_t a = 0; a < D; ++a) node[a] += Tile<D>::cells * o[a];
  return node;
}
/// The node's number in the holder's block.
template <int D>
int node_in_holder(const TileGrid<D>& grid, const TileHolder& holder, const Index<D>& node) {
  return shape_of(grid, holder).node(seen_from<D>(holder, node));
}

/// A tile's nodes in a holder's block.
template <int D>
struct HeldNodes {
  std::uint64_t with_mass;  // a bit each by Tile<D>::cell
  std::int64_t first = 0;   // where the record of the tile's first node is, or would be
  Index<D> stride{};        // from record to record along each axis

  /// Find out where the records are.
  void locate(TileGrid<D>& grid, const TileHolder& holder) {
    const BlockShape<D>& shape = shape_of(grid, holder);
    // May be a number before the block's own: only nodes with mass are asked for, and these are in
    // it.
    first = grid.nodes.index_of(grid.block(holder.patch).records.data) +
            std::int64_t{node_in_holder<D>(grid, holder, Index<D>{})};
    for (std::size_t a = 0, step = 1; a < D; step *= static_cast<std::size_t>(shape.nodes[a++]))
      stride[a] = static_cast<std::int32_t>(step);
  }
  /// Of the record of a node `with_mass`, by its coordinates from the tile's first
  /// (NodeMemory::record_at).
  std::uint32_t place(const Index<D>& node) const {
    std::int64_t at = first;
    for (std::size_t a = 0; a < D; ++a) at += std::int64_t{stride[a]} * node[a];
    return static_cast<std::uint32_t>(at);
  }
};

/// The nodes at which bodies have mass, a bit each, of the blocks of all patches that have nodes
/// where bodies may meet.
template <int D>
class NodesWithMass {
 public:
  void find(TileGrid<D>& grid, Threads& threads) {
    words_ = static_cast<std::size_t>(
                 BlockShape<D>::count_max(grid.reach().before, grid.reach().after)) /
                 64 +
             2;  // one to read beyond
    bits_.assign(grid.patches.size() * words_, 0);
    threads.for_each(grid.patches.size(), [&](std::size_t p) {
      if (!grid.patches[p].in_contact) return;
      const NodeBlock<D> block = grid.block(p);
      std::uint64_t* bits = &bits_[p * words_];
      for (int n = 0; n < block.count; ++n)
        // Any mass counts, be it 1e-30: whether bodies touch there is left to the gap, eq. (5).
        bits[n / 64] |= std::uint64_t{block.mass()[n] > 0.0} << n % 64;
    });
  }

  /// Those of a tile's nodes, a bit each by Tile<D>::cell, that are in a holder's block.
  std::uint64_t in_tile(const TileGrid<D>& grid, const TileHolder& holder) const {
    static_assert(Tile<D>::cell_count <= 64);
    const int cells = Tile<D>::cells;
    const BlockShape<D>& shape = shape_of(grid, holder);
    const Index<D> o = Tile<D>::offset(holder.neighbour), last = shape.last();
    Index<D> low, high;
    for (std::size_t a = 0; a < D; ++a) {
      low[a] = std::max(0, shape.low[a] - cells * o[a]);
      high[a] = std::min(cells - 1, last[a] - cells * o[a]);
      if (low[a] > high[a]) return 0;
    }
    const std::uint64_t row = low_bits(high[0] - low[0] + 1);
    const std::uint64_t* bits = &bits_[static_cast<std::size_t>(holder.patch) * words_];
    std::uint64_t nodes = 0;
    // Row by row: a row of the tile is at most eight bits that follow one another in the block too.
    const int layer = node_in_holder<D>(grid, holder, low), cell = Tile<D>::cell(low);
    for (int z = 0; z <= (D == 3 ? high[D - 1] - low[D - 1] : 0); ++z)
      for (int y = 0; y <= high[1] - low[1]; ++y) {
        const int n = layer + (z * shape.nodes[1] + y) * shape.nodes[0];
        nodes |= (bits_from(bits, n) & row) << (cell + (z * cells + y) * cells);
      }
    return nodes;
  }

  std::size_t bytes() const { return bytes_of(bits_); }

 private:
  std::size_t words_ = 0;  // of a patch
  std::vector<std::uint64_t> bits_;
};

}  // namespace mpm
