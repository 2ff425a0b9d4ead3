#include "mpm/grid/halo.hpp"

#include <algorithm>
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

/// What is exchanged: of each node the first `numbers` from begin_of(patch) on, `stride` apart.
template <class Begin>
struct Numbers {
  std::size_t numbers, stride;
  Begin begin_of;
  std::size_t bytes() const { return numbers * sizeof(double); }
};
template <int D>
auto records_of(TileGrid<D>& grid, int first, int last) {
  const auto begin_of = [&grid, first](const Patch<D>& p) {
    return grid.block(p).records.data + first;
  };
  return Numbers<decltype(begin_of)>{static_cast<std::size_t>(last - first), record, begin_of};
}
template <int D>
auto dashpots_of(TileGrid<D>& grid) {
  const auto begin_of = [&grid](const Patch<D>& p) { return grid.block(p).dashpots().data; };
  return Numbers<decltype(begin_of)>{half_record, half_record, begin_of};
}
template <int D>
auto springs_of(TileGrid<D>& grid) {
  const auto begin_of = [&grid](const Patch<D>& p) { return grid.block(p).springs.data; };
  return Numbers<decltype(begin_of)>{wall_record, wall_record, begin_of};
}

template <int D>
auto kept_of(TileGrid<D>& grid, int number) {
  const auto begin_of = [&grid, number](const Patch<D>& p) {
    return p.keeps ? grid.block(p).displacements.data + number : nullptr;
  };
  return Numbers<decltype(begin_of)>{1, half_record, begin_of};
}

/// f(first number) of the nodes of runs.
template <int D, class Begin, class F>
void for_each_node(TileGrid<D>& grid, const std::vector<NodeRun>& runs, const Numbers<Begin>& what,
                   F&& f) {
  for (const NodeRun& run : runs) {
    double* node = what.begin_of(grid.patches[run.patch]);
    if (node == nullptr) continue;  // without springs of walls, to both ranks
    node += run.first * what.stride;
    for (int n = 0; n < run.count; ++n, node += what.stride) f(node);
  }
}

template <int D, class Begin>
std::size_t bytes_of(TileGrid<D>& grid, const std::vector<NodeRun>& runs,
                     const Numbers<Begin>& what) {
  std::size_t nodes = 0;
  for (const NodeRun& run : runs)
    if (what.begin_of(grid.patches[run.patch]) != nullptr) nodes += run.count;
  return nodes * what.bytes();
}

template <int D, class Begin>
void start(TileGrid<D>& grid, Mail& mail, const Numbers<Begin>& what) {
  Partition<D>& partition = grid.partition;
  partition.comm->release(mail);
  mail.out.resize(partition.partners.size());
  mail.in.resize(partition.partners.size());
  for (std::size_t k = 0; k < partition.partners.size(); ++k) {
    const Partner& partner = partition.partners[k];
    mail.out[k].rank = mail.in[k].rank = partner.rank;
    mail.out[k].bytes.resize(bytes_of(grid, partner.give, what));
    mail.in[k].bytes.resize(bytes_of(grid, partner.take, what));
    std::byte* to = mail.out[k].bytes.data();
    for_each_node(grid, partner.give, what, [&](const double* node) {
      std::memcpy(to, node, what.bytes());
      to += what.bytes();
    });
  }
  partition.comm->start(mail);
}

template <int D, class Begin>
void finish(TileGrid<D>& grid, Mail& mail, const Numbers<Begin>& what) {
  Partition<D>& partition = grid.partition;
  partition.comm->finish(mail);
  for (std::size_t k = 0; k < partition.partners.size(); ++k) {
    const std::byte* from = mail.in[k].bytes.data();
    for_each_node(grid, partition.partners[k].take, what, [&](double* node) {
      std::memcpy(node, from, what.bytes());
      from += what.bytes();
    });
  }
}

/// Which patches come first: those with nodes that others read, and foreign ones, whose blocks are
/// cleared before what comes is put there.
template <int D>
void find_edge(TileGrid<D>& grid) {
  Partition<D>& partition = grid.partition;
  std::vector<std::uint32_t>& edge = partition.edge;
  edge.clear();
  for (const Partner& partner : partition.partners)
    for (const NodeRun& run : partner.give)
      if (edge.empty() || edge.back() != run.patch) edge.push_back(run.patch);
  for (std::uint32_t p = 0; p < grid.patches.size(); ++p)
    if (grid.patches[p].foreign) edge.push_back(p);
  std::ranges::sort(edge);
  const auto twice = std::ranges::unique(edge);
  edge.erase(twice.begin(), twice.end());
  partition.inside.clear();
  auto next = edge.begin();
  for (std::uint32_t p = 0; p < grid.patches.size(); ++p)
    if (next != edge.end() && *next == p)
      ++next;
    else
      partition.inside.push_back(p);
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
  find_edge(grid);
}

template <int D>
void start_nodes(TileGrid<D>& grid, int first, int last) {
  start(grid, grid.partition.mail.nodes, records_of(grid, first, last));
}
template <int D>
void finish_nodes(TileGrid<D>& grid, int first, int last) {
  finish(grid, grid.partition.mail.nodes, records_of(grid, first, last));
}

template <int D>
void exchange_and_sum(TileGrid<D>& grid, Threads& threads, int first, int last) {
  if (!grid.partition.alone()) {
    start_nodes(grid, first, last);
    finish_nodes(grid, first, last);
  }
  sum_shared_nodes(grid, threads, first, last);
}
template <int D>
void exchange_and_sum_kept(TileGrid<D>& grid, Threads& threads, int number) {
  if (!grid.partition.alone()) {
    start(grid, grid.partition.mail.kept, kept_of(grid, number));
    finish(grid, grid.partition.mail.kept, kept_of(grid, number));
  }
  sum_kept_number(grid, threads, number);
}

template <int D>
void start_at_walls(TileGrid<D>& grid) {
  if (grid.has_dashpots) start(grid, grid.partition.mail.dashpots, dashpots_of(grid));
  if (grid.has_wall_springs) start(grid, grid.partition.mail.springs, springs_of(grid));
}
template <int D>
void finish_at_walls(TileGrid<D>& grid) {
  if (grid.has_dashpots) finish(grid, grid.partition.mail.dashpots, dashpots_of(grid));
  if (grid.has_wall_springs) finish(grid, grid.partition.mail.springs, springs_of(grid));
}

template void plan_halo<2>(TileGrid<2>&);
template void plan_halo<3>(TileGrid<3>&);
template void start_nodes<2>(TileGrid<2>&, int, int);
template void start_nodes<3>(TileGrid<3>&, int, int);
template void finish_nodes<2>(TileGrid<2>&, int, int);
template void finish_nodes<3>(TileGrid<3>&, int, int);
template void exchange_and_sum<2>(TileGrid<2>&, Threads&, int, int);
template void exchange_and_sum<3>(TileGrid<3>&, Threads&, int, int);
template void exchange_and_sum_kept<2>(TileGrid<2>&, Threads&, int);
template void exchange_and_sum_kept<3>(TileGrid<3>&, Threads&, int);
template void start_at_walls<2>(TileGrid<2>&);
template void start_at_walls<3>(TileGrid<3>&);
template void finish_at_walls<2>(TileGrid<2>&);
template void finish_at_walls<3>(TileGrid<3>&);

}  // namespace mpm
