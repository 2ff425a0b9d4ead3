// What contact keeps from step to step, saved and restored. What is restored is looked at before it
// is used: it may be anything.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mpm/contact/contact.hpp"

namespace mpm {
namespace {

constexpr const char* damaged = "its contacts are damaged";

/// Pairs of two bodies or more.
bool is_pair_count(std::uint32_t pairs) {
  const auto sides = static_cast<std::uint32_t>(std::lround(0.5 + std::sqrt(0.25 + 2.0 * pairs)));
  return pairs > 0 && pair_count(sides) == pairs;
}

/// The pairs of one node follow those of another.
template <int D>
void check_cached(const ContactPart<D>& part) {
  const auto& nodes = part.cached_nodes;
  StateStream::check(nodes.empty() == part.cached.empty(), damaged);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::size_t begin = nodes[n].first_pair;
    const std::size_t end = n + 1 < nodes.size() ? nodes[n + 1].first_pair : part.cached.size();
    StateStream::check((n > 0 || begin == 0) && begin < end && end <= part.cached.size() &&
                           is_pair_count(static_cast<std::uint32_t>(end - begin)),
                       damaged);
    StateStream::check_flag(nodes[n].solved);
  }
}

}  // namespace

template <int D>
void exchange_contact(Contact<D>& contact, StateStream& stream, std::size_t bodies) {
  stream.same(contact.tiles.size(), "its patches and its contacts do not agree");
  for (ContactTile<D>& tile : contact.tiles)
    stream(tile.cached, tile.cached_part, tile.first_cached);
  stream.length(contact.parts, 2 * sizeof(std::size_t));
  for (ContactPart<D>& part : contact.parts) {
    // The last_ arrays are not saved: start() exchanges both before they are read.
    stream.vector(part.cached_nodes);
    stream.vector(part.cached);
  }
  stream.vector(contact.cache.displacement);
  stream.vector(contact.cache.fastest);
  contact.records.exchange(stream);
  std::size_t unconverged = contact.unconverged.load();
  stream(contact.cache.last_time_step, contact.counts.overlapped, contact.counts.overlapped_max,
         contact.counts.bodies_max, unconverged);
  contact.unconverged.store(unconverged);
  if (!stream.restores()) return;
  for (const ContactPart<D>& part : contact.parts) check_cached(part);
  for (const ContactTile<D>& tile : contact.tiles) {
    if (tile.cached == 0) continue;
    StateStream::check(tile.cached_part < contact.parts.size(), damaged);
    const auto nodes = static_cast<std::size_t>(std::popcount(tile.cached));
    StateStream::check(
        tile.first_cached + nodes <= contact.parts[tile.cached_part].cached_nodes.size(), damaged);
  }
  for (const std::size_t size : {contact.cache.displacement.size(), contact.cache.fastest.size()})
    StateStream::check(size == 0 || size == bodies, damaged);
  StateStream::check(contact.counts.bodies_max >= 0 &&
                         static_cast<std::size_t>(contact.counts.bodies_max) <= bodies,
                     damaged);
  contact.records.check_restored(bodies);
  for (std::size_t b = 0; b < contact.cache.fastest.size(); ++b)
    if (contact.cache.fastest[b] > 0.0) contact.cache.moving.push_back(static_cast<int>(b));
}

template void exchange_contact<2>(Contact<2>&, StateStream&, std::size_t);
template void exchange_contact<3>(Contact<3>&, StateStream&, std::size_t);

}  // namespace mpm
