#pragma once
// The overlapped nodes of some tiles that follow one another: what one thread finds and solves at a
// time.
#include <algorithm>
#include <vector>

#include "mpm/contact/contact_node.hpp"
#include "mpm/contact/pair_records.hpp"
#include "mpm/fields/lists.hpp"

namespace mpm {

/// An overlapped node of the last step. Its pairs are used again until the bodies of one of them
/// have moved by ContactSettings::normal_refresh_distance, or others are there.
struct CachedNode {
  std::uint64_t membership_hash;  // a number for the bodies and how many particles each has
  std::uint32_t first_pair;       // of ContactPart::cached
  bool solved;                    // its contacts were solved, and the gaps are those after the step
};

/// The normal and the gap of a pair of bodies at a node.
template <int D>
struct CachedPair {
  Vec<double, D> normal;  // from the body with the lower number
  double gap;             // [m]
  double displacement;    // of both bodies (PairCache) when it was found [m]
};

/// Nodes where bodies may act on each other. Those at which all are apart are counted and left out,
/// unless pairs are cached from step to step.
template <int D>
struct ContactPart {
  std::vector<ContactNode> nodes;
  std::vector<BodyAtNode<D>> sides;
  std::vector<ContactPair<D>> pairs;
  std::vector<std::uint32_t> further_places;  // of records of the sides, each node's in a row
  std::size_t overlapped = 0;                 // nodes, those left out too
  int bodies_max = 0;                         // at a node
  std::vector<PairShare> shares;  // scratch: of the step; those of one pair may be several
  // Scratch: ContactSums of the part.
  ExactSum energy, force_work, friction, friction_first, stored;
  // Where pairs are cached: of this step and the last, in the order of `nodes` and of `pairs`.
  std::vector<CachedNode> cached_nodes, last_cached_nodes;
  std::vector<CachedPair<D>> cached, last_cached;

  std::span<BodyAtNode<D>> sides_of(const ContactNode& node) {
    return {&sides[node.first_side], node.sides};
  }
  std::span<ContactPair<D>> pairs_of(const ContactNode& node) {
    return {&pairs[node.first_pair], pair_count(node.sides)};
  }
  /// f(place) of a side's record in each patch that has it (NodeMemory::record_at).
  template <class F>
  void for_each_place(const BodyAtNode<D>& side, F&& f) const {
    f(side.place);
    for (std::uint32_t k = 0; k < side.further_count; ++k)
      f(further_places[side.first_further + k]);
  }
  /// May any pair at a node act? Other nodes stay as they are, to the last bit.
  bool any_gap_closed(const ContactNode& node) {
    return std::ranges::any_of(pairs_of(node), &ContactPair<D>::gap_closed);
  }
  CachedNode& cached_of(const ContactNode& node) {
    return cached_nodes[static_cast<std::size_t>(&node - nodes.data())];
  }

  void start() {
    nodes.clear();
    sides.clear();
    pairs.clear();
    further_places.clear();
    overlapped = 0;
    bodies_max = 0;
    std::swap(cached, last_cached);
    std::swap(cached_nodes, last_cached_nodes);
    cached.clear();
    cached_nodes.clear();
  }
  /// Room for nodes, sides, pairs and further places beyond those that are there, and some to
  /// spare, so that numbers which creep up seldom allocate.
  void reserve(std::size_t more_nodes, std::size_t more_sides, std::size_t more_pairs,
               std::size_t more_places) {
    const auto grow = [](auto& v, std::size_t more) {
      const std::size_t size = v.size() + more;
      if (size > v.capacity()) v.reserve(size + std::max<std::size_t>(size / 8, 32));
    };
    grow(nodes, more_nodes);
    grow(sides, more_sides);
    grow(pairs, more_pairs);
    grow(further_places, more_places);
  }
  /// Leave out the nodes from the first-th on for which `stays(node)` does not hold.
  template <class F>
  void leave_out(std::size_t first, F&& stays) {
    if (first == nodes.size()) return;
    std::size_t kept = first;
    std::uint32_t side = nodes[first].first_side, pair = nodes[first].first_pair;
    const auto places_of = [&](const ContactNode& node) {
      return further_places.begin() + static_cast<std::ptrdiff_t>(first_further_of(node));
    };
    // Everything moves to the front in the order it has, so that each range is copied onto itself
    // or towards the front.
    auto place = places_of(nodes[first]);
    for (std::size_t n = first; n < nodes.size(); ++n) {
      ContactNode node = nodes[n];
      if (!stays(node)) continue;
      const auto from = places_of(node);
      std::ptrdiff_t count = 0;
      for (BodyAtNode<D>& s : sides_of(node)) {
        count += s.further_count;
        s.first_further -= static_cast<std::uint32_t>(from - place);
      }
      place = std::copy(from, from + count, place);
      std::ranges::copy(sides_of(node), &sides[side]);
      std::ranges::copy(pairs_of(node), &pairs[pair]);
      node.first_side = side;
      node.first_pair = pair;
      side += node.sides;
      pair += pair_count(node.sides);
      nodes[kept++] = node;
    }
    nodes.resize(kept);
    sides.resize(side);
    pairs.resize(pair);
    further_places.erase(place, further_places.end());
  }

  std::size_t bytes() const {
    return sizeof(*this) + bytes_of(nodes) + bytes_of(sides) + bytes_of(pairs) +
           bytes_of(further_places) + bytes_of(shares) + bytes_of(cached_nodes) +
           bytes_of(last_cached_nodes) + bytes_of(cached) + bytes_of(last_cached);
  }

 private:
  /// Where a node's further places begin: its sides have been sorted since they were noted.
  std::uint32_t first_further_of(const ContactNode& node) {
    return std::ranges::min(sides_of(node), {}, &BodyAtNode<D>::first_further).first_further;
  }
};

}  // namespace mpm
