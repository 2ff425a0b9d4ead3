#pragma once
// The contact of any number of bodies at one node: who is there, along which normals, and the
// impulses between them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mpm/contact/settings.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// One body at an overlapped node.
template <int D>
struct Side {
  int body;
  std::uint32_t first_copy,
      copies;       // the patches that hold the node for this body (ContactGrid::holders_)
  bool prescribed;  // the body moves as it does, whatever pushes it
  double mass;  // [kg]; of a rigid body, with its share of the whole body's; of a prescribed one
                // infinite, but where it hardly reaches the node
  double mapped_mass;        // from the particles [kg]
  Vec<double, D> mapped;     // velocity mapped from the particles [m/s]
  Vec<double, D> velocity;   // after the contact of eqs. (6)-(7) [m/s]
  Vec<double, D> increment;  // prescribed for this step [m/s]
  Vec<double, D> momentum;   // working momentum of the solver [kg m/s]; of a prescribed body what
                             // it has been pushed with
  Vec<double, D> base;       // velocity of a prescribed body, else 0 [m/s]

  /// Give it a velocity and an impulse to start from.
  void start(const Vec<double, D>& v, const Vec<double, D>& impulse) {
    base = prescribed ? v : Vec<double, D>::zero();
    momentum = prescribed ? Vec<double, D>::zero() : mass * v + impulse;
  }
  /// Velocity in the solver.
  Vec<double, D> working_velocity() const { return base + (1.0 / mass) * momentum; }
  /// Velocity that comes of it.
  Vec<double, D> end_velocity() const { return prescribed ? base : (1.0 / mass) * momentum; }
};

/// m_r m_s / (m_r + m_s); one of the two may be infinite.
inline double reduced_mass(double r, double s) {
  if (std::isinf(r)) return s;
  return std::isinf(s) ? r : r * s / (r + s);
}

/// Two bodies at an overlapped node.
template <int D>
struct SidePair {
  std::uint16_t r, s;     // sides of the node, by number
  bool closed;            // the gap test, eq. (5), has passed
  bool touching;          // closed, and approaching or at rest: forces may act
  bool acted;             // an impulse of eqs. (6)-(7) or (11)-(15) has acted in this step
  double friction;        // coefficient of friction
  double gap;             // distance of the two surfaces along the normal [m]
  double normal_impulse;  // of the last solution [N s]
  Vec<double, D> normal;  // from r to s
  Vec<double, D> friction_impulse;  // of the last solution, on s [N s]
  Vec<double, D> impulse;           // on r, over this step [N s]
  double friction_work;             // over this step, with the mean slip [J]
  double friction_first;            // the same with the slip at its start [J]
};

/// An overlapped node: its sides and its pairs.
struct ContactNode {
  std::uint16_t cell;  // the node's place in its tile, as the cell whose first node it is
  std::uint16_t sides;
  std::uint32_t first_side, first_pair;
  unsigned held;      // axes held by walls
  double energy;      // work of the contact beyond friction, over this step [J]
  double force_work;  // work of the contact forces at the velocities of the force mapping [J]
};

constexpr std::uint32_t pair_count(std::uint32_t sides) { return sides * (sides - 1) / 2; }

/// Put the bodies at a node into an order that does not depend on how bodies are numbered, as far
/// as masses and velocities tell them apart: the solution for several bodies with friction is not
/// unique, and the order of its steps chooses.
template <int D>
void sort_sides(std::span<Side<D>> sides) {
  std::sort(sides.begin(), sides.end(), [](const Side<D>& x, const Side<D>& y) {
    if (x.mass != y.mass) return x.mass > y.mass;
    for (int a = 0; a < D; ++a)
      if (x.mapped[a] != y.mapped[a]) return x.mapped[a] > y.mapped[a];
    return x.body < y.body;
  });
}

/// Remove the approach of every closed pair, eqs. (6)-(7), working on Side::momentum; with
/// friction, hold the tangential motion as far as Coulomb's law allows, eqs. (14)-(15). For two
/// bodies this is the paper's formula; more are solved together by projected Gauss-Seidel in a
/// fixed order, to 1e-12 of the largest impulse or to the rounding of their momenta.
/// `takes_part(pair)` chooses the pairs. Sets normal_impulse and friction_impulse of every pair (0
/// for the others). Gives false if it stopped short of the tolerance.
template <int D, bool with_friction, class Choose>
bool solve_node(Side<D>* sides, SidePair<D>* pairs, std::uint32_t count, Choose&& takes_part) {
  constexpr int most_sweeps = 20000;
  constexpr double tolerance = 1e-12;
  // Bodies that move together exert impulses on each other that are rounding: no sweeps settle
  // them.
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  double unresolved = 0.0;
  for (std::uint32_t k = 0; k < count; ++k) {
    pairs[k].normal_impulse = 0.0;
    pairs[k].friction_impulse = Vec<double, D>::zero();
    if (count == 1) continue;
    const double lighter =
        std::min(norm(sides[pairs[k].r].momentum), norm(sides[pairs[k].s].momentum));
    unresolved = std::max(unresolved, rounding * lighter);
  }
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0.0, scale = 0.0;
    for (std::uint32_t k = 0; k < count; ++k) {
      SidePair<D>& pair = pairs[k];
      if (!takes_part(pair)) continue;
      Side<D>& r = sides[pair.r];
      Side<D>& s = sides[pair.s];
      const double m_rs = reduced_mass(r.mass, s.mass);
      const Vec<double, D> relative = r.working_velocity() - s.working_velocity();
      const double normal = std::max(pair.normal_impulse + m_rs * dot(relative, pair.normal), 0.0);
      Vec<double, D> impulse = (normal - pair.normal_impulse) * pair.normal;
      change = std::max(change, std::abs(normal - pair.normal_impulse));
      scale = std::max(scale, normal);
      pair.normal_impulse = normal;
      if constexpr (with_friction) {
        Vec<double, D> slip = relative - dot(relative, pair.normal) * pair.normal;
        Vec<double, D> hold = pair.friction_impulse + m_rs * slip;
        const double limit = pair.friction * normal, needed = norm(hold);
        if (needed > limit) hold = (limit / needed) * hold;
        const Vec<double, D> difference = hold - pair.friction_impulse;
        change = std::max(change, norm(difference));
        pair.friction_impulse = hold;
        impulse += difference;
      }
      r.momentum -= impulse;
      s.momentum += impulse;
    }
    if (count == 1 || change <= std::max(tolerance * scale, unresolved)) return true;
  }
  return false;
}

}  // namespace mpm
