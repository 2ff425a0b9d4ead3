// Nodes that are left out: the others keep their sides, their pairs and the places of their
// records.
#include <random>
#include <vector>

#include "check.hpp"
#include "mpm/contact/contact_part.hpp"

namespace {

using namespace mpm;

/// A node with so many sides, each with some further places; every place and gap is another.
void add_node(ContactPart<3>& part, std::uint32_t sides, std::mt19937_64& random) {
  ContactNode& node = part.nodes.emplace_back();
  node.sides = static_cast<std::uint16_t>(sides);
  node.tile = static_cast<std::uint32_t>(part.nodes.size());  // tells nodes apart
  node.first_side = static_cast<std::uint32_t>(part.sides.size());
  node.first_pair = static_cast<std::uint32_t>(part.pairs.size());
  for (std::uint32_t k = 0; k < sides; ++k) {
    BodyAtNode<3>& side = part.sides.emplace_back();
    side.body = static_cast<std::int32_t>(k);
    side.mass = std::uniform_real_distribution<double>(0.1, 1.0)(random);
    side.mapped = Vec<double, 3>::zero();
    side.place = static_cast<std::uint32_t>(random());
    side.first_further = static_cast<std::uint32_t>(part.further_places.size());
    side.further_count = static_cast<std::uint8_t>(random() % 4);
    for (int f = 0; f < side.further_count; ++f)
      part.further_places.push_back(static_cast<std::uint32_t>(random()));
  }
  for (std::uint32_t k = 0; k < pair_count(sides); ++k)
    part.pairs.emplace_back().gap = static_cast<double>(random());
  sort_sides(part.sides_of(node));
}

/// All that a node has.
std::vector<double> contents(ContactPart<3>& part, const ContactNode& node) {
  std::vector<double> all{static_cast<double>(node.tile)};
  for (const BodyAtNode<3>& side : part.sides_of(node)) {
    all.push_back(side.body);
    part.for_each_place(side, [&](std::uint32_t place) { all.push_back(place); });
  }
  for (const ContactPair<3>& pair : part.pairs_of(node)) all.push_back(pair.gap);
  return all;
}

}  // namespace

void test_contact_part(mpm::testing::Report& report) {
  std::mt19937_64 random(7);
  for (int turn = 0; turn < 40; ++turn) {
    ContactPart<3> part;
    std::vector<std::vector<double>> expected;
    // Tile by tile: what was kept before is not looked at again.
    for (int tile = 0; tile < 4; ++tile) {
      const std::size_t first = part.nodes.size();
      for (std::uint64_t n = random() % 6; n > 0; --n)
        add_node(part, 2 + static_cast<std::uint32_t>(random() % 3), random);
      const auto stays = [&](const ContactNode& node) { return (node.tile + turn) % 3 != 0; };
      for (std::size_t n = first; n < part.nodes.size(); ++n)
        if (stays(part.nodes[n])) expected.push_back(contents(part, part.nodes[n]));
      part.leave_out(first, stays);
      CHECK_EQUAL(part.nodes.size(), expected.size());
    }
    for (std::size_t n = 0; n < expected.size(); ++n)
      CHECK(contents(part, part.nodes[n]) == expected[n], turn, n);
    if (expected.empty()) CHECK(part.sides.empty() && part.further_places.empty(), turn);
  }
}
