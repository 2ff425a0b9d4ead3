#pragma once
// What is kept of the contact at one node through a step: who is there, along which normals, and
// what has passed between them.
#include <algorithm>
#include <cstdint>
#include <span>

#include "mpm/math/vec.hpp"

namespace mpm {

/// One body at an overlapped node.
template <int D>
struct BodyAtNode {
  std::int32_t body;
  std::uint32_t place;  // of its record in the first patch that has it (NodeMemory::record_at)
  std::uint32_t first_further;  // of ContactPart::further_places: its records in further patches
  std::uint8_t further_count;
  bool prescribed;  // the body moves as it does, whatever pushes it
  double mass;  // [kg]; of a rigid body, with its share of the whole body's; of a prescribed one
                // infinite, but where it hardly reaches the node
  Vec<double, D> mapped;  // velocity mapped from the particles [m/s]
};

/// theta of F + theta k dt u, u being the approach at the end of the step. It acts as a dashpot
/// theta k dt. With 0 bodies at rest gain energy, as the stiffness of the nodes is not quite
/// symmetric; 1/2 and 1/4 are stable at the same steps, and 1/4 damps half as hard (decision 0063).
inline constexpr double share_of_approach = 0.25;

/// The springs between two bodies, as a node has them; none without stiffness.
struct ContactSpring {
  double force = 0.0;      // at the start of the step [N]
  double stiffness = 0.0;  // by which it grows with the approach [N/m]
  double energy = 0.0;     // that is stored at the start of the step [J]

  /// What is stored after an approach by so much [m].
  double energy_after(double way) const {
    return force + stiffness * way > 0.0 ? energy + way * (force + 0.5 * stiffness * way) : 0.0;
  }
};

/// Two bodies at an overlapped node.
template <int D>
struct ContactPair {
  std::uint16_t r, s;     // sides of the node, by number
  bool gap_closed;        // the gap test, eq. (5), has passed
  bool active;            // closed, and approaching or at rest: forces may act
  bool loaded;            // an impulse of eqs. (6)-(7) or (11)-(15) has acted in this step
  bool bonded;            // the two have one velocity at the node, in whatever direction
  bool stopped;           // approach is stopped, eqs. (6)-(7); else springs part them
  double friction;        // coefficient of friction
  double gap;             // distance of the two surfaces along the normal [m]
  Vec<double, D> normal;  // from r to s
  ContactSpring spring;   // where Response::springs
  double normal_impulse;  // over this step [N s]
  Vec<double, D> friction_impulse;  // on s, over this step [N s]; of a bond all of its impulse
  double friction_work;             // over this step, with the mean slip [J]
  double friction_first;            // the same with the slip at its start [J]

  /// On r, over this step [N s].
  Vec<double, D> impulse() const { return -normal_impulse * normal - friction_impulse; }
};

/// An overlapped node: its sides and its pairs.
struct ContactNode {
  std::uint8_t cell;              // the node's place in its tile, as the cell whose own node it is
  std::uint8_t constrained_axes;  // axes held by walls, a bit each
  std::uint16_t sides;
  std::uint32_t tile;  // of Contact::tiles
  std::uint32_t first_side, first_pair;
  double energy;      // work of the contact beyond friction, over this step [J]
  double force_work;  // work of the contact forces at the velocities of the force mapping [J]
  double stored;      // in springs, after this step [J]
};

constexpr std::uint32_t pair_count(std::uint32_t sides) { return sides * (sides - 1) / 2; }

/// Put the bodies at a node into an order that does not depend on how bodies are numbered, as far
/// as masses and velocities tell them apart. Pairs that are alike in all that `order_pairs` knows
/// of are swept in that order.
template <int D>
void sort_sides(std::span<BodyAtNode<D>> sides) {
  std::sort(sides.begin(), sides.end(), [](const BodyAtNode<D>& x, const BodyAtNode<D>& y) {
    if (x.mass != y.mass) return x.mass > y.mass;
    for (int a = 0; a < D; ++a)
      if (x.mapped[a] != y.mapped[a]) return x.mapped[a] > y.mapped[a];
    return x.body < y.body;
  });
}

}  // namespace mpm
