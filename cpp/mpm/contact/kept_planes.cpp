#include "mpm/contact/kept_planes.hpp"

#include <algorithm>

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

template <int D>
void write_tile(Letter& letter, const KeptTile<D>& kept) {
  write(letter, kept.tile);
  write(letter, kept.cached);
  write(letter, kept.nodes.size());
  for (const CachedNode& node : kept.nodes) write(letter, node);
  write(letter, kept.pairs.size());
  for (const CachedPair<D>& pair : kept.pairs) write(letter, pair);
}

template <int D>
KeptTile<D> read_tile(Reader& reader) {
  KeptTile<D> kept;
  kept.tile = reader.read<Index<D>>();
  kept.cached = reader.read<std::uint64_t>();
  kept.nodes.resize(reader.read<std::size_t>());
  for (CachedNode& node : kept.nodes) node = reader.read<CachedNode>();
  kept.pairs.resize(reader.read<std::size_t>());
  for (CachedPair<D>& pair : kept.pairs) pair = reader.read<CachedPair<D>>();
  return kept;
}

}  // namespace

template <int D>
std::vector<KeptTile<D>> kept_tiles(const Contact<D>& contact) {
  std::vector<KeptTile<D>> kept;
  for (const ContactTile<D>& tile : contact.tiles) {
    if (tile.cached == 0) continue;
    const ContactPart<D>& part = contact.parts[tile.cached_part];
    const auto count = static_cast<std::size_t>(std::popcount(tile.cached));
    const auto first = part.cached_nodes.begin() + tile.first_cached;
    const auto last = first + static_cast<std::ptrdiff_t>(count);
    // The pairs of one node follow those of another.
    const std::size_t begin = first->first_pair,
                      end = last == part.cached_nodes.end() ? part.cached.size() : last->first_pair;
    KeptTile<D>& one = kept.emplace_back();
    one.tile = tile.tile;
    one.cached = tile.cached;
    one.nodes.assign(first, last);
    for (CachedNode& node : one.nodes) node.first_pair -= static_cast<std::uint32_t>(begin);
    one.pairs.assign(part.cached.begin() + static_cast<std::ptrdiff_t>(begin),
                     part.cached.begin() + static_cast<std::ptrdiff_t>(end));
  }
  std::ranges::sort(kept, tile_less<D>, &KeptTile<D>::tile);
  return kept;
}

template <int D>
void keep_tiles(Contact<D>& contact, const std::vector<KeptTile<D>>& kept) {
  contact.parts.resize(std::max<std::size_t>(1, contact.parts.size()));
  for (ContactPart<D>& part : contact.parts) {
    part.cached_nodes.clear();
    part.cached.clear();
  }
  ContactPart<D>& part = contact.parts[0];
  for (ContactTile<D>& tile : contact.tiles) {
    tile.cached = 0;
    const auto found = std::ranges::lower_bound(kept, tile.tile, tile_less<D>, &KeptTile<D>::tile);
    if (found == kept.end() || found->tile != tile.tile) continue;
    tile.cached = found->cached;
    tile.cached_part = 0;
    tile.first_cached = static_cast<std::uint32_t>(part.cached_nodes.size());
    const auto begin = static_cast<std::uint32_t>(part.cached.size());
    for (CachedNode node : found->nodes) {
      node.first_pair += begin;
      part.cached_nodes.push_back(node);
    }
    part.cached.insert(part.cached.end(), found->pairs.begin(), found->pairs.end());
  }
}

template <int D>
std::vector<KeptTile<D>> exchange_kept(const std::vector<KeptTile<D>>& kept,
                                       const Partition<D>& partition, bool to_first) {
  Comm& comm = *partition.comm;
  Mail mail;
  std::vector<KeptTile<D>> have;
  for (const KeptTile<D>& tile : kept) {
    const int rank = to_first ? 0 : partition.owners.rank_of(tile.tile);
    if (rank == comm.rank())
      have.push_back(tile);
    else
      write_tile(letter_to(mail, rank), tile);
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) have.push_back(read_tile<D>(reader));
  std::ranges::sort(have, tile_less<D>, &KeptTile<D>::tile);
  return have;
}

template std::vector<KeptTile<2>> kept_tiles<2>(const Contact<2>&);
template std::vector<KeptTile<3>> kept_tiles<3>(const Contact<3>&);
template void keep_tiles<2>(Contact<2>&, const std::vector<KeptTile<2>>&);
template void keep_tiles<3>(Contact<3>&, const std::vector<KeptTile<3>>&);
template std::vector<KeptTile<2>> exchange_kept<2>(const std::vector<KeptTile<2>>&,
                                                   const Partition<2>&, bool);
template std::vector<KeptTile<3>> exchange_kept<3>(const std::vector<KeptTile<3>>&,
                                                   const Partition<3>&, bool);

}  // namespace mpm
