#pragma once
// Nodes that hardly any matter reaches follow others (Hoellig, Reif & Wipper 2001: extended
// B-splines). Beyond an edge of a body that lies askew to the cells there are nodes that one
// particle alone reaches; their motions that do not strain it are held by nothing, and their masses
// may be next to none. So a node of a body on nodes of its own leads if a cell among the 3^D that
// its function reaches is filled to 1.499 / 2^D at least (by more than one particle where 2^D fill
// it), and others follow: with j such a node and i those that lead near it,
//   u_j = sum_i e_ji u_i,   e_ji = w_ji (1, X_i - X_j) . c_j,   w = |X_i - X_j|^-4,
//   sum_i w_ji (1, X_i - X_j) (1, X_i - X_j)^T c_j = (1, 0),                                 (E1)
// which is the linear field that meets theirs best: sum e = 1, sum e X_i = X_j, so that all motions
// that are linear in the body are met exactly. Mass and force of j are given to i by the transpose,
//   m_i += sum_j e_ji m_j,   f_i += sum_j e_ji f_j,                                          (E2)
// which keeps momentum, moments and power. Near are those within a diagonal of a cell, or, until
// they determine the field, the square root of two, twice, three times of it. A cell is the box
// about a node.
#include "mpm/fields/lists.hpp"
#include "mpm/followers/node_table.hpp"

namespace mpm {

/// A node's part in a sum of others'.
struct NodeShare {
  double share = 0.0;        // e
  std::uint32_t from = 0;    // of the table of those who give
  std::uint32_t turned = 0;  // components of vectors that a wall turns between the two, a bit each
};
/// A node of a block, and the sum that is for it.
struct SumAtNode {
  std::int32_t node = 0;
  std::uint32_t sum = 0;
};

/// Sums of what some nodes give, each for another node of the same body: for all of those that
/// patches here have, counted there or not.
template <int D>
struct SumsOfNodes {
  NodeTable<D> from;
  Lists<NodeShare> shares;  // of each sum
  std::vector<Vec<double, D>> sums;
  Lists<SumAtNode> nodes;  // by place in Followers::patches

  std::size_t bytes() const {
    return from.bytes() + shares.bytes() + bytes_of(sums) + nodes.bytes();
  }
};

/// A share of a force that acts on a node in the place of one beyond walls, which leads.
template <int D>
struct ForceBeyond {
  std::int32_t node = 0;  // counted by the patch
  NodeShare of;
  Index<D> beyond{};
};

template <int D>
struct Followers {
  PatchesOfNodes<D> patches;         // that have any of them
  SumsOfNodes<D> given, taken;       // (E2), for who leads; (E1), for who follows
  Lists<ForceBeyond<D>> beyond;      // by place in `patches`
  std::vector<std::uint8_t> follow;  // scratch: 1 of the patches with nodes that follow
  bool exist = false;  // on any rank: those without take part in what ranks tell each other

  std::size_t bytes() const {
    return bytes_of(patches.all) + given.bytes() + taken.bytes() + beyond.bytes();
  }
};

}  // namespace mpm
