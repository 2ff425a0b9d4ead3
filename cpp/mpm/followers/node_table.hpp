#pragma once
// Vectors of single nodes of bodies that keep their nodes, gathered from the patches that count
// them for all ranks that ask for them.
#include <compare>
#include <cstdint>
#include <vector>

#include "mpm/comm/comm.hpp"
#include "mpm/fields/lists.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/parallel/threads.hpp"

namespace mpm {

/// A node of a body, by its index.
template <int D>
struct NodeOfBody {
  std::int32_t body = 0;
  Index<D> node{};

  friend auto operator<=>(const NodeOfBody&, const NodeOfBody&) = default;
};

/// Patches that keep their nodes, by what stays: their numbers change when others come and go.
template <int D>
struct PatchesOfNodes {
  struct Kept {
    std::int32_t body = 0;
    Index<D> tile{};
    std::uint32_t patch = 0;
  };
  std::vector<Kept> all;
};
/// Find them again if they have other numbers by now.
template <int D>
void find_again(PatchesOfNodes<D>& patches, const TileGrid<D>& grid);

template <int D>
struct NodeTable {
  /// Where a node is here; patch -1: another rank counts it.
  struct Place {
    std::int32_t patch = -1, node = 0;  // the patch by its place in PatchesOfNodes
  };
  struct Partner {
    int rank = 0;
    std::vector<std::uint32_t> give{}, take{};  // places in `nodes`
  };
  std::vector<NodeOfBody<D>> nodes;  // in order
  std::vector<Place> places;         // of each
  std::vector<Partner> partners;
  std::vector<Vec<double, D>> values;
  Mail mail;

  std::size_t bytes() const {
    std::size_t all = bytes_of(nodes) + bytes_of(places) + bytes_of(values);
    for (const Partner& partner : partners) all += bytes_of(partner.give) + bytes_of(partner.take);
    return all;
  }
};

/// Find where the nodes of a table are, which is in order, and who tells whom of those of other
/// ranks. All ranks call it together.
template <int D>
void plan(NodeTable<D>& table, const PatchesOfNodes<D>& patches, const TileGrid<D>& grid);

/// Tell other ranks of the values that they ask for, and be told.
template <int D>
void tell(NodeTable<D>& table, Comm& comm);

/// Let the values be those that get(block, node) points to, so many numbers; all ranks together.
template <int width, int D, class Get>
void gather(NodeTable<D>& table, const PatchesOfNodes<D>& patches, TileGrid<D>& grid,
            Threads& threads, Get&& get) {
  constexpr std::size_t at_once = 256;
  table.values.resize(table.nodes.size());
  threads.for_each((table.nodes.size() + at_once - 1) / at_once, [&](std::size_t part) {
    const std::size_t end = std::min(table.nodes.size(), (part + 1) * at_once);
    for (std::size_t k = part * at_once; k < end; ++k) {
      const typename NodeTable<D>::Place& place = table.places[k];
      if (place.patch < 0) continue;
      const auto& patch = patches.all[static_cast<std::size_t>(place.patch)];
      const double* const numbers = get(grid.block(patch.patch), place.node);
      for (int a = 0; a < width; ++a) table.values[k][a] = numbers[a];
    }
  });
  tell(table, *grid.partition.comm);
}
}  // namespace mpm
