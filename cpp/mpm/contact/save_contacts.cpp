// What contact keeps from step to step, saved and restored. What is restored is looked at before it
// is used: it may be anything.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "mpm/contact/kept_planes.hpp"

namespace mpm {
namespace {

/// Pairs of two bodies or more.
bool is_pair_count(std::uint32_t pairs) {
  const auto sides = static_cast<std::uint32_t>(std::lround(0.5 + std::sqrt(0.25 + 2.0 * pairs)));
  return pairs > 0 && pair_count(sides) == pairs;
}

/// The planes that are kept, tile by tile: the rank of each gets its own.
template <int D>
void exchange_planes(Contact<D>& contact, StateStream& stream, const Partition<D>& partition) {
  std::vector<Index<D>> tiles;
  std::vector<std::uint64_t> cached, hashes;
  std::vector<std::uint8_t> solved;
  std::vector<std::uint32_t> counts;  // of the pairs of each node
  std::vector<CachedPair<D>> pairs;
  if (!stream.restores())
    for (const KeptTile<D>& kept : exchange_kept(kept_tiles(contact), partition, true)) {
      tiles.push_back(kept.tile);
      cached.push_back(kept.cached);
      for (std::size_t n = 0; n < kept.nodes.size(); ++n) {
        const bool last = n + 1 == kept.nodes.size();
        hashes.push_back(kept.nodes[n].membership_hash);
        solved.push_back(kept.nodes[n].solved ? 1 : 0);
        counts.push_back(
            (last ? static_cast<std::uint32_t>(kept.pairs.size()) : kept.nodes[n + 1].first_pair) -
            kept.nodes[n].first_pair);
      }
      pairs.insert(pairs.end(), kept.pairs.begin(), kept.pairs.end());
    }
  stream.vector(tiles);
  stream.vector(cached);
  stream.vector(hashes);
  stream.vector(solved);
  stream.vector(counts);
  stream.vector(pairs);
  if (!stream.restores()) return;
  const auto check = [](bool holds) { StateStream::check(holds, damaged_contacts); };
  check(tiles.size() == cached.size() && hashes.size() == counts.size() &&
        solved.size() == counts.size());
  std::vector<KeptTile<D>> all(tiles.size());
  std::size_t node = 0, pair = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    KeptTile<D>& kept = all[t];
    kept.tile = tiles[t];
    kept.cached = cached[t];
    check(t == 0 || tile_less<D>(tiles[t - 1], tiles[t]));
    const std::size_t end = node + static_cast<std::size_t>(std::popcount(cached[t]));
    check(cached[t] != 0 && end <= counts.size());
    for (; node < end; ++node) {
      check(is_pair_count(counts[node]) && counts[node] <= pairs.size() - pair);
      kept.nodes.push_back(
          {hashes[node], static_cast<std::uint32_t>(kept.pairs.size()), solved[node] != 0});
      for (const std::size_t last = pair + counts[node]; pair < last; ++pair)
        kept.pairs.push_back(pairs[pair]);
    }
  }
  check(node == counts.size() && pair == pairs.size());
  keep_tiles(contact, all);
}

}  // namespace

template <int D>
void exchange_contact(Contact<D>& contact, StateStream& stream, std::size_t bodies,
                      const Partition<D>& partition) {
  exchange_planes(contact, stream, partition);
  stream.vector(contact.cache.displacement);
  stream.vector(contact.cache.fastest);
  contact.records.exchange(stream);
  // Of all ranks; restored, the first has it.
  const bool first = stream.comm().rank() == 0;
  std::int64_t unconverged =
      all_sum(stream.comm(), static_cast<std::int64_t>(contact.unconverged.load()));
  stream(contact.cache.last_time_step, contact.counts.overlapped, contact.counts.overlapped_max,
         contact.counts.bodies_max, unconverged);
  if (!stream.restores()) return;
  contact.unconverged.store(first ? static_cast<std::size_t>(unconverged) : 0);
  for (const std::size_t size : {contact.cache.displacement.size(), contact.cache.fastest.size()})
    StateStream::check(size == 0 || size == bodies, damaged_contacts);
  StateStream::check(contact.counts.bodies_max >= 0 &&
                         static_cast<std::size_t>(contact.counts.bodies_max) <= bodies,
                     damaged_contacts);
  contact.records.check_restored(bodies, first);
  for (std::size_t b = 0; b < contact.cache.fastest.size(); ++b)
    if (contact.cache.fastest[b] > 0.0) contact.cache.moving.push_back(static_cast<int>(b));
}

template void exchange_contact<2>(Contact<2>&, StateStream&, std::size_t, const Partition<2>&);
template void exchange_contact<3>(Contact<3>&, StateStream&, std::size_t, const Partition<3>&);

}  // namespace mpm
