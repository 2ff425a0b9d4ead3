// What contact keeps from step to step, saved and restored. What is restored is looked at before it
// is used: it may be anything.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mpm/contact/contact_grid.hpp"

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
void check_known(const ContactPart<D>& part) {
  const auto& nodes = part.known_nodes;
  StateStream::check(nodes.empty() == part.known.empty(), damaged);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::size_t begin = nodes[n].first_pair;
    const std::size_t end = n + 1 < nodes.size() ? nodes[n + 1].first_pair : part.known.size();
    StateStream::check((n > 0 || begin == 0) && begin < end && end <= part.known.size() &&
                           is_pair_count(static_cast<std::uint32_t>(end - begin)),
                       damaged);
    StateStream::check_flag(nodes[n].solved);
  }
}

void check_records(const std::vector<PairRecord>& records, std::size_t places, std::size_t bodies) {
  const auto is_body = [&](int b) { return b >= 0 && static_cast<std::size_t>(b) < bodies; };
  for (std::size_t k = 0; k < records.size(); ++k) {
    const PairRecord& r = records[k];
    const bool later =
        k == 0 || std::pair(records[k - 1].a, records[k - 1].b) < std::pair(r.a, r.b);
    StateStream::check(is_body(r.a) && is_body(r.b) && r.a < r.b && later, damaged);
  }
  StateStream::check((places == 0 && records.empty()) ||
                         (std::has_single_bit(places) && 2 * records.size() <= places),
                     damaged);
}

}  // namespace

template <int D>
void ContactGrid<D>::exchange(StateStream& stream, std::size_t bodies) {
  stream.same(tiles_.size(), "its patches and its contacts do not agree");
  for (ContactTile<D>& tile : tiles_) stream(tile.known, tile.known_part, tile.first_known);
  stream.length(parts_, 2 * sizeof(std::size_t));
  for (Part& part : parts_) {
    stream.vector(part.known_nodes);
    stream.vector(part.known);
  }
  stream.vector(travel_);
  stream.vector(fastest_);
  stream.vector(records_);
  stream.vector(places_);
  std::size_t unconverged = unconverged_.load();
  stream(last_time_step_, overlapped_, nodes_max_, bodies_max_, unconverged);
  unconverged_.store(unconverged);
  if (!stream.restores()) return;
  for (const Part& part : parts_) check_known(part);
  for (const ContactTile<D>& tile : tiles_) {
    if (tile.known == 0) continue;
    StateStream::check(tile.known_part < parts_.size(), damaged);
    const auto nodes = static_cast<std::size_t>(std::popcount(tile.known));
    StateStream::check(tile.first_known + nodes <= parts_[tile.known_part].known_nodes.size(),
                       damaged);
  }
  for (const std::size_t size : {travel_.size(), fastest_.size()})
    StateStream::check(size == 0 || size == bodies, damaged);
  StateStream::check(bodies_max_ >= 0 && static_cast<std::size_t>(bodies_max_) <= bodies, damaged);
  check_records(records_, places_.size(), bodies);
  sort_records();
}

template void ContactGrid<2>::exchange(StateStream&, std::size_t);
template void ContactGrid<3>::exchange(StateStream&, std::size_t);

}  // namespace mpm
