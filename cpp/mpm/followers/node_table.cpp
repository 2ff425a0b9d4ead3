#include "mpm/followers/node_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "mpm/comm/all_sums.hpp"
#include "mpm/comm/letters.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {
namespace {

template <int D>
struct Wanted {
  NodeOfBody<D> node;
  std::int32_t rank = 0;    // who asks
  std::uint32_t place = 0;  // and its place there
};
/// Who has what is wanted.
struct Found {
  std::uint64_t wanted = 0;
  std::int32_t rank = 0;
};

template <int D>
typename NodeTable<D>::Partner& partner_with(NodeTable<D>& table, int rank) {
  for (auto& partner : table.partners)
    if (partner.rank == rank) return partner;
  table.partners.push_back({rank});
  return table.partners.back();
}

template <int D>
std::uint32_t place_in(const NodeTable<D>& table, const NodeOfBody<D>& node) {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(table.nodes, node) -
                                    table.nodes.begin());
}

template <int D>
void find_places(NodeTable<D>& table, const PatchesOfNodes<D>& patches, const TileGrid<D>& grid) {
  table.places.assign(table.nodes.size(), {});
  for (std::size_t k = 0; k < patches.all.size(); ++k) {
    const Patch<D>& patch = grid.patches[patches.all[k].patch];
    for (int n = 0; n < patch.shape.node_count; ++n) {
      if (!patch.counts(n)) continue;
      const NodeOfBody<D> node{patch.body, index_of(grid, patch, n)};
      const std::uint32_t at = place_in(table, node);
      if (at < table.nodes.size() && table.nodes[at] == node)
        table.places[at] = {static_cast<std::int32_t>(k), n};
    }
  }
}

}  // namespace

template <int D>
void find_again(PatchesOfNodes<D>& patches, const TileGrid<D>& grid) {
  for (auto& kept : patches.all) {
    if (kept.patch < grid.patches.size() && grid.patches[kept.patch].body == kept.body &&
        grid.patches[kept.patch].tile == kept.tile)
      continue;
    const int p = find_patch<D>(grid, kept.body, kept.tile);
    if (p < 0) throw std::logic_error("a tile of a body has no patch");
    kept.patch = static_cast<std::uint32_t>(p);
  }
}

template <int D>
void plan(NodeTable<D>& table, const PatchesOfNodes<D>& patches, const TileGrid<D>& grid) {
  find_places(table, patches, grid);
  table.partners.clear();
  Comm& comm = *grid.partition.comm;
  if (comm.alone()) return;
  std::vector<Wanted<D>> wanted;
  for (std::uint32_t k = 0; k < table.nodes.size(); ++k)
    if (table.places[k].patch < 0) wanted.push_back({table.nodes[k], comm.rank(), k});
  entries_of_all(comm, wanted);
  std::ranges::sort(wanted, [](const Wanted<D>& x, const Wanted<D>& y) {
    return std::tie(x.rank, x.place) < std::tie(y.rank, y.place);
  });
  const auto here = [&](const Wanted<D>& one) {
    const std::uint32_t at = place_in(table, one.node);
    return at < table.nodes.size() && table.nodes[at] == one.node && table.places[at].patch >= 0
               ? static_cast<std::int64_t>(at)
               : std::int64_t{-1};
  };
  std::vector<Found> found;
  for (std::uint64_t k = 0; k < wanted.size(); ++k)
    if (wanted[k].rank != comm.rank() && here(wanted[k]) >= 0) found.push_back({k, comm.rank()});
  entries_of_all(comm, found);
  std::ranges::sort(found, {}, &Found::wanted);  // in one order at both
  for (const Found& one : found) {
    const Wanted<D>& of = wanted[one.wanted];
    if (one.rank == comm.rank())
      partner_with(table, of.rank).give.push_back(static_cast<std::uint32_t>(here(of)));
    if (of.rank == comm.rank()) partner_with(table, one.rank).take.push_back(of.place);
  }
}

template <int D>
void tell(NodeTable<D>& table, Comm& comm) {
  if (comm.alone()) return;
  Mail& mail = table.mail;
  comm.release(mail);
  mail.out.assign(table.partners.size(), {});
  mail.in.assign(table.partners.size(), {});
  for (std::size_t k = 0; k < table.partners.size(); ++k) {
    const auto& partner = table.partners[k];
    mail.out[k].rank = mail.in[k].rank = partner.rank;
    for (const std::uint32_t place : partner.give) write(mail.out[k], table.values[place]);
    extend(mail.in[k], partner.take.size() * sizeof(Vec<double, D>));
  }
  comm.start(mail);
  comm.finish(mail);
  for (std::size_t k = 0; k < table.partners.size(); ++k) {
    Reader reader(mail.in[k]);
    for (const std::uint32_t place : table.partners[k].take)
      table.values[place] = reader.template read<Vec<double, D>>();
  }
}

template void find_again<2>(PatchesOfNodes<2>&, const TileGrid<2>&);
template void find_again<3>(PatchesOfNodes<3>&, const TileGrid<3>&);
template void plan<2>(NodeTable<2>&, const PatchesOfNodes<2>&, const TileGrid<2>&);
template void plan<3>(NodeTable<3>&, const PatchesOfNodes<3>&, const TileGrid<3>&);
template void tell<2>(NodeTable<2>&, Comm&);
template void tell<3>(NodeTable<3>&, Comm&);

}  // namespace mpm
