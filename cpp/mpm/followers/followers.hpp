#pragma once
// Nodes that hardly any matter reaches follow others (Hoellig, Reif & Wipper 2001: extended
// B-splines). Beyond an edge of a body that lies askew to the cells there are nodes that one
// particle alone reaches; their motions that do not strain it are held by nothing, and their masses
// may be next to none. So a node of a body on nodes of its own leads if a cell among the 3^D that
// its function reaches is filled to 1.5 / 2^D at least, by more than one of 2^D particles, and
// others follow: with j such a node and i those that lead near it,
//   u_j = sum_i e_ji u_i,   e_ji = w_ji (1, X_i - X_j) . c_j,   w = |X_i - X_j|^-4,
//   sum_i w_ji (1, X_i - X_j) (1, X_i - X_j)^T c_j = (1, 0),                                 (E1)
// which is the linear field that meets theirs best: sum e = 1, sum e X_i = X_j, so that all motions
// that are linear in the body are met exactly. Mass and force of j are given to i by the transpose,
//   m_i += sum_j e_ji m_j,   f_i += sum_j e_ji f_j,                                          (E2)
// which keeps momentum, moments and power. A cell is the box about a node.
#include <cstdint>
#include <vector>

#include "mpm/followers/node_table.hpp"

namespace mpm {

/// A share of the motion of one node in that of another, or of its force in the other's.
template <int D>
struct NodeLink {
  std::uint32_t from = 0;   // of the table of those who give
  double share = 0.0;       // e
  std::uint8_t turned = 0;  // components of vectors that a wall turns between the two, a bit each
  Index<D> beyond{};        // the one who leads, where it lies: maybe beyond a wall
};
/// Those of a node of a block.
struct NodeLinks {
  std::int32_t node = 0;
  std::uint32_t first = 0, count = 0;
};

template <int D>
struct Followers {
  PatchesOfNodes<D> patches;        // that have any of them
  NodeTable<D> following, leading;  // their forces; their motions
  // By place in `patches`: who leads, and follows, there.
  std::vector<std::vector<NodeLinks>> leads, follows;
  std::vector<std::vector<NodeLink<D>>> to_leading, to_following;

  bool exist = false;  // on any rank: those without take part in what ranks tell each other
};

}  // namespace mpm
