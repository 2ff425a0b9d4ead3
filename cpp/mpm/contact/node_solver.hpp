#pragma once
// The impulses between any number of bodies at one node.
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "mpm/math/vec.hpp"

namespace mpm {

/// One body at a node while its contacts are solved.
template <int D>
struct SolvedSide {
  double mass;              // [kg]; infinite or nearly so for a prescribed body
  bool prescribed;          // the body moves as it does, whatever pushes it
  Vec<double, D> momentum;  // [kg m/s]; of a prescribed body what it has been pushed with
  Vec<double, D> base;      // velocity of a prescribed body, else 0 [m/s]

  /// Give it a velocity and an impulse to start from.
  void start(const Vec<double, D>& v, const Vec<double, D>& impulse) {
    base = prescribed ? v : Vec<double, D>::zero();
    momentum = prescribed ? Vec<double, D>::zero() : mass * v + impulse;
  }
  /// Of its momentum; a prescribed one has no end of it.
  double size() const {
    return prescribed ? std::numeric_limits<double>::infinity() : norm(momentum);
  }
  /// Velocity in the solver.
  // A prescribed body of infinite mass keeps `base`, as 1 / mass is 0. One that hardly reaches the
  // node has a finite mass (rigid_masses.cpp) and gives way in the solver, but its motion is given
  // all the same: hence two velocities.
  Vec<double, D> working_velocity() const { return base + (1.0 / mass) * momentum; }
  /// Velocity that comes of it.
  Vec<double, D> end_velocity() const { return prescribed ? base : (1.0 / mass) * momentum; }
};

/// The spring between two bodies over a step: the impulse if they move as they do, and by how much
/// it grows with their approach at the end [N s per m/s].
struct SolvedSpring {
  double impulse = 0.0, per_approach = 0.0;
  bool exists = false;

  /// The impulse J of both together, J = impulse + per_approach (v - J / m), given v without it.
  double solve(double reduced_mass, double approach_without) const {
    return (impulse + per_approach * approach_without) / (1.0 + per_approach / reduced_mass);
  }
};

/// Two bodies at a node while its contacts are solved.
template <int D>
struct SolvedPair {
  std::uint16_t r, s;                                        // sides, by number
  bool takes_part;                                           // else nothing acts between the two
  bool bonded;                                               // it holds in whatever direction
  double friction;                                           // coefficient of friction
  Vec<double, D> normal;                                     // from r to s; of a bond none
  SolvedSpring spring = {};                                  // else the approach is stopped
  double normal_impulse = 0.0;                               // [N s]
  Vec<double, D> friction_impulse = Vec<double, D>::zero();  // on s [N s]; of a bond all of it
};

/// The bodies at a node and the pairs of them.
template <int D>
struct NodeSolution {
  std::vector<SolvedSide<D>> sides;
  std::vector<SolvedPair<D>> pairs;
  std::vector<std::uint32_t> order = {};  // pairs that take part, as they are swept (order_pairs)
};

/// m_r m_s / (m_r + m_s); one of the two may be infinite.
inline double reduced_mass(double r, double s) {
  if (std::isinf(r)) return s;
  return std::isinf(s) ? r : r * s / (r + s);
}

/// The normal impulse of a pair that has to be, with the relative velocity that all impulses so far
/// have left.
// Eqs. (6)-(7): (m_s p_r - m_r p_s) . n / (m_r + m_s) = m_rs (v_r - v_s) . n. The whole impulse is
// kept from below zero, not the change of this sweep: what other pairs have pushed since may take
// some of it back, and only the sum must not pull.
template <int D>
double normal_impulse_of(const SolvedPair<D>& pair, double m_rs, const Vec<double, D>& relative) {
  const double approach = dot(relative, pair.normal);
  if (pair.spring.exists)
    return std::max(pair.spring.solve(m_rs, approach + pair.normal_impulse / m_rs), 0.0);
  return std::max(pair.normal_impulse + m_rs * approach, 0.0);
}

/// Give a bonded pair the velocity that one field of their masses and momenta would have; returns
/// the size of the impulse [N s].
template <int D>
double hold_together(SolvedPair<D>& pair, const Vec<double, D>& hold, SolvedSide<D>& r,
                     SolvedSide<D>& s) {
  pair.friction_impulse += hold;
  r.momentum -= hold;
  s.momentum += hold;
  return norm(hold);
}

/// How well the impulses at a node can be known [N s].
// Bodies that move together exert impulses on each other that are rounding: no sweeps settle them.
template <int D>
double rounding_of(const NodeSolution<D>& node) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  double unresolved = 0.0;
  // A single pair needs no tolerance: its first sweep is exact.
  if (node.pairs.size() > 1)
    for (const SolvedPair<D>& pair : node.pairs) {
      // What one pair can settle is limited by the rounding of the lighter momentum; a prescribed
      // body has no such limit.
      const double lighter = std::min(node.sides[pair.r].size(), node.sides[pair.s].size());
      unresolved = std::max(unresolved, rounding * lighter);
    }
  return unresolved;
}

/// Put the pairs in an order of their masses and motions, which does not depend on how the bodies
/// are numbered: sweeps end within a tolerance, and which pair begins would be seen in the last
/// digits. Pairs that are equal in these keep the order of the sides.
template <int D>
void order_pairs(NodeSolution<D>& node) {
  const std::vector<SolvedSide<D>>& sides = node.sides;
  const std::vector<SolvedPair<D>>& pairs = node.pairs;
  node.order.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    // What does not take part is kept in the list, so that pairs of the solution and of the node
    // have the same numbers.
    if (pairs[k].takes_part) node.order.push_back(static_cast<std::uint32_t>(k));
  if (node.order.size() < 2) return;
  const auto key = [&](std::uint32_t k) {
    const SolvedPair<D>& pair = pairs[k];
    const SolvedSide<D>&r = sides[pair.r], &s = sides[pair.s];
    // None changes when r and s are exchanged; + 0.0, so that there is no -0.
    const Vec<double, D> relative = r.working_velocity() - s.working_velocity();
    return std::array{reduced_mass(r.mass, s.mass),
                      pair.bonded ? norm(relative) : dot(relative, pair.normal) + 0.0,
                      pair.spring.impulse};
  };
  // A strong order, for a run that is about to stop may have what is no number here.
  std::ranges::sort(node.order, [&](std::uint32_t a, std::uint32_t b) {
    const auto of_a = key(a), of_b = key(b);
    for (std::size_t k = 0; k < of_a.size(); ++k)
      if (const auto order = std::strong_order(of_a[k], of_b[k]); order != 0) return order < 0;
    return a < b;
  });
}

/// Remove the approach of every pair that takes part, eqs. (6)-(7), working on
/// SolvedSide::momentum, and all relative motion of one that is bonded; with friction, hold the
/// tangential motion as far as Coulomb's law allows, eqs. (14)-(15). For two bodies this is the
/// paper's formula; more are solved together by projected Gauss-Seidel, to 1e-12
/// of the largest impulse or to the rounding of their momenta. Pairs come in without impulses.
/// Gives false if it stopped short of the tolerance.
template <bool with_friction, int D>
bool solve_node(NodeSolution<D>& node) {
  auto& [sides, pairs, order] = node;
  order_pairs(node);
  // Hundreds of bodies at a node would otherwise take minutes a step: what a sweep costs grows with
  // the square of their number.
  constexpr std::size_t most_sweeps = 20000, fewest_sweeps = 20, most_solved_pairs = 500'000;
  const std::size_t sweeps = std::clamp(most_solved_pairs / std::max<std::size_t>(pairs.size(), 1),
                                        fewest_sweeps, most_sweeps);
  constexpr double tolerance = 1e-12;
  const double unresolved = rounding_of(node);
  for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
    double change = 0.0, scale = 0.0;
    for (const std::uint32_t k : order) {
      SolvedPair<D>& pair = pairs[k];
      SolvedSide<D>& r = sides[pair.r];
      SolvedSide<D>& s = sides[pair.s];
      const double m_rs = reduced_mass(r.mass, s.mass);
      const Vec<double, D> relative = r.working_velocity() - s.working_velocity();
      if (pair.bonded) {
        change = std::max(change, hold_together(pair, m_rs * relative, r, s));
        scale = std::max(scale, norm(pair.friction_impulse));
        continue;
      }
      const double normal = normal_impulse_of(pair, m_rs, relative);
      Vec<double, D> impulse = (normal - pair.normal_impulse) * pair.normal;
      change = std::max(change, std::abs(normal - pair.normal_impulse));
      // The tolerance is relative to the largest impulse at the node: a light pair beside a heavy
      // one need not be better known than the heavy one is.
      scale = std::max(scale, normal);
      pair.normal_impulse = normal;
      if constexpr (with_friction) {
        // The change along n does not alter the slip, so both may be taken from one relative
        // velocity.
        Vec<double, D> slip = relative - dot(relative, pair.normal) * pair.normal;
        Vec<double, D> hold = pair.friction_impulse + m_rs * slip;
        const double limit = pair.friction * normal, needed = norm(hold);
        // Back to Coulomb's cone along the radius, by the normal impulse of this very sweep, eq.
        // (14): the direction is that of the slip which is left, so friction opposes it.
        if (needed > limit) hold = (limit / needed) * hold;
        const Vec<double, D> difference = hold - pair.friction_impulse;
        change = std::max(change, norm(difference));
        pair.friction_impulse = hold;
        impulse += difference;
      }
      // One vector with both signs: momentum is conserved to rounding whether or not sweeps settle.
      r.momentum -= impulse;
      s.momentum += impulse;
    }
    if (order.size() < 2 || change <= std::max(tolerance * scale, unresolved)) return true;
  }
  return false;
}

}  // namespace mpm
