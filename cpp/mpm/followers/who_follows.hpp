#pragma once
// Which nodes of a body follow others, and how (followers.hpp), by how much of its cells is filled
// and the masses of its nodes.
#include <algorithm>
#include <span>
#include <type_traits>
#include <vector>

#include "mpm/followers/node_table.hpp"

namespace mpm {

/// How much of a cell is filled, and the mass of a node: of all ranks.
template <int D>
struct OfNode {
  NodeOfBody<D> node;
  double value = 0.0;
};
template <int D>
using OnesOfBody = std::span<const OfNode<D>>;  // of one body, by node

template <int D>
double value_of(OnesOfBody<D> all, const std::type_identity_t<Index<D>>& node) {
  const auto index = [](const OfNode<D>& one) -> const Index<D>& { return one.node.node; };
  const auto at = std::ranges::lower_bound(all, node, {}, index);
  return at != all.end() && at->node.node == node ? at->value : 0.0;
}

/// Whom a node follows, and how: a node before the walls, maybe in the place of one beyond.
template <int D>
struct Leader {
  Index<D> node{}, beyond{};
  double share = 0.0;
  unsigned turned = 0;
};
template <int D>
struct Follower {
  NodeOfBody<D> node;
  double mass = 0.0;
  std::vector<Leader<D>> leaders{};
};

/// Those of a body, `at_start` or later: who follows has no mass by then.
template <int D>
void add_followers(const Walls<D>& walls, OnesOfBody<D> cells, OnesOfBody<D> masses, bool at_start,
                   std::vector<Follower<D>>& all);

}  // namespace mpm
