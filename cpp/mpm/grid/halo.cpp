#include "mpm/grid/halo.hpp"

#include <cstring>

#include "mpm/grid/shared_nodes.hpp"

namespace mpm {
namespace {

Partner& partner_with(std::vector<Partner>& partners, int rank) {
  for (Partner& partner : partners)
    if (partner.rank == rank) return partner;
  partners.push_back({rank, {}, {}});
  return partners.back();
}

template <int D>
int owner_of(const TileGrid<D>& grid, const Patch<D>& patch) {
  return patch.foreign ? patch.owner : grid.partition.comm->rank();
}

/// f(q) for the patches beside a patch that share its nodes and lie in tiles of a rank.
template <int D, class F>
void for_each_beside(const TileGrid<D>& grid, const Patch<D>& patch, int rank, F&& f) {
  // Where bodies are bonded all in a tile have the nodes of the first of them.
  for (const std::int32_t q : grid.patches[patch.primary].neighbour) {
    if (q < 0) continue;
    const Patch<D>& other = grid.patches[static_cast<std::size_t>(q)];
    if (other.tile != patch.tile && owner_of(grid, other) == rank) f(other);
  }
}

/// The nodes of a patch in tiles of a rank beside it.
template <int D>
void add_tiles(const TileGrid<D>& grid, const Patch<D>& patch, int rank, NodeBits<D>& read) {
  for (int k = 0; k < Tile<D>::neighbours; ++k) {
    const Index<D> o = Tile<D>::offset(k);
    Index<D> tile = patch.tile, low = patch.shape.low, high = patch.shape.last();
    bool any = k != Tile<D>::self;
    for (std::size_t a = 0; a < D; ++a) {
      tile[a] += o[a];
      low[a] = std::max(low[a], Tile<D>::cells * o[a]);
      high[a] = std::min(high[a], Tile<D>::cells * (o[a] + 1) - 1);
      any = any && low[a] <= high[a];
    }
    if (!any || grid.partition.owners.rank_of(tile) != rank) continue;
    for_each_index<D>(low, high,
                      [&](const Index<D>& node) { read.set_row(patch.shape.node(node), 1); });
  }
}

/// The nodes of a patch that a rank reads, by those of its patches beside it: the same to the rank
/// that has the patch and to the one that reads it.
template <int D>
void add_runs(const TileGrid<D>& grid, std::uint32_t p, int rank, std::vector<NodeRun>& runs) {
  const Patch<D>& patch = grid.patches[p];
  NodeBits<D> read;
  read.fill(0);
  for_each_beside(grid, patch, rank, [&](const Patch<D>& other) {
    for_each_shared_row(patch, other, [&](int here, int, int count) { read.set_row(here, count); });
  });
  if (grid.partition.shares_tiles) add_tiles(grid, patch, rank, read);
  for (int n = 0; n < patch.shape.node_count;) {
    if (!read[n]) {
      ++n;
      continue;
    }
    int end = n;
    while (end < patch.shape.node_count && read[end]) ++end;
    runs.push_back({p, static_cast<std::uint16_t>(n), static_cast<std::uint16_t>(end - n)});
    n = end;
  }
}

std::size_t nodes_in(const std::vector<NodeRun>& runs) {
  std::size_t nodes = 0;
  for (const NodeRun& run : runs) nodes += run.count;
  return nodes;
}

/// `numbers` of each node, `stride` apart, from begin_of(patch) on.
template <int D, class F>
void exchange(TileGrid<D>& grid, std::size_t numbers, std::size_t stride, F&& begin_of) {
  Partition<D>& partition = grid.partition;
  Mail& mail = partition.mail.nodes;
  const std::size_t size = numbers * sizeof(double);
  const auto for_each_node = [&](const std::vector<NodeRun>& runs, auto&& f) {
    for (const NodeRun& run : runs) {
      double* node = begin_of(grid.patches[run.patch]) + run.first * stride;
      for (int n = 0; n < run.count; ++n, node += stride) f(node);
    }
  };
  mail.out.resize(partition.partners.size());
  mail.in.resize(partition.partners.size());
  for (std::size_t k = 0; k < partition.partners.size(); ++k) {
    const Partner& partner = partition.partners[k];
    mail.out[k].rank = mail.in[k].rank = partner.rank;
    mail.out[k].bytes.resize(nodes_in(partner.give) * size);
    mail.in[k].bytes.resize(nodes_in(partner.take) * size);
    std::byte* to = mail.out[k].bytes.data();
    for_each_node(partner.give, [&](const double* node) {
      std::memcpy(to, node, size);
      to += size;
    });
  }
  partition.comm->start(mail);
  partition.comm->finish(mail);
  for (std::size_t k = 0; k < partition.partners.size(); ++k) {
    const std::byte* from = mail.in[k].bytes.data();
    for_each_node(partition.partners[k].take, [&](double* node) {
      std::memcpy(node, from, size);
      from += size;
    });
  }
}

}  // namespace

template <int D>
void plan_halo(TileGrid<D>& grid) {
  Partition<D>& partition = grid.partition;
  std::vector<Partner>& partners = partition.partners;
  for (Partner& partner : partners) {
    partner.give.clear();
    partner.take.clear();
  }
  for (std::uint32_t p = 0; p < grid.patches.size(); ++p) {
    const Patch<D>& patch = grid.patches[p];
    // Patches that are empty for a while give nothing.
    if (patch.cells() == 0) continue;
    if (patch.foreign) {
      add_runs(grid, p, partition.comm->rank(), partner_with(partners, patch.owner).take);
    } else if (patch.readers > 0) {
      for (const int rank : partition.readers[static_cast<std::size_t>(patch.readers)])
        add_runs(grid, p, rank, partner_with(partners, rank).give);
    }
  }
  // Both sides know who has nothing to do with whom.
  std::erase_if(partners, [](const Partner& partner) {
    return partner.give.empty() && partner.take.empty();
  });
}

template <int D>
void exchange_nodes(TileGrid<D>& grid, int first, int last) {
  exchange(grid, static_cast<std::size_t>(last - first), record,
           [&](const Patch<D>& p) { return grid.block(p).records.data + first; });
}

template <int D>
void exchange_dashpots(TileGrid<D>& grid) {
  exchange(grid, half_record, half_record,
           [&](const Patch<D>& p) { return grid.block(p).dashpots().data; });
}

template void plan_halo<2>(TileGrid<2>&);
template void plan_halo<3>(TileGrid<3>&);
template void exchange_nodes<2>(TileGrid<2>&, int, int);
template void exchange_nodes<3>(TileGrid<3>&, int, int);
template void exchange_dashpots<2>(TileGrid<2>&);
template void exchange_dashpots<3>(TileGrid<3>&);

}  // namespace mpm
