// What contact does at the nodes: velocities, forces, remapped velocities.
#include "mpm/contact/respond.hpp"

#include <algorithm>

#include "mpm/rigid/prescribed_motion.hpp"

namespace mpm {
namespace {

/// Scratch of one thread for the solution at a node with these sides and pairs;
/// `takes_part(pair)` chooses the pairs that act.
template <int D, class Choose>
NodeSolution<D>& solution_of(std::span<const BodyAtNode<D>> sides,
                             std::span<const ContactPair<D>> pairs, Choose&& takes_part) {
  // Grows to the largest crowd once: a step must not allocate.
  thread_local NodeSolution<D> solution;
  solution.sides.resize(sides.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    solution.sides[k].mass = sides[k].mass;
    solution.sides[k].prescribed = sides[k].prescribed;
  }
  solution.pairs.clear();
  for (const ContactPair<D>& pair : pairs)
    solution.pairs.push_back(
        {pair.r, pair.s, takes_part(pair), pair.bonded, pair.friction, pair.normal});
  return solution;
}

/// The force over a step with the approach at its end: F + k u dt / 4 (share_of_approach).
SolvedSpring spring_over(const ContactSpring& spring, double time_step) {
  return {time_step * spring.force, share_of_approach * time_step * time_step * spring.stiffness,
          spring.stiffness > 0.0};
}

template <bool with_friction, int D>
void solve(Contact<D>& contact, NodeSolution<D>& solution) {
  // A count and nothing else: no order between threads is needed.
  if (!solve_node<with_friction>(solution))
    contact.unconverged.fetch_add(1, std::memory_order_relaxed);
}

/// f(part, node) for the nodes where any pair may act. The memory is told of them in time.
template <int D, class F>
void for_each_gap_closed(Contact<D>& contact, TileGrid<D>& grid, Threads& threads, F&& f) {
  // The blocks of a node's bodies lie far apart, so each is a miss of the caches (decision 0013). A
  // tile belongs to one part and a node to one tile, so no two threads write to one record.
  constexpr std::size_t ahead = 6;
  const auto fetch = [&](ContactPart<D>& part, const ContactNode& node) {
    if (!part.any_gap_closed(node)) return;
    for (const BodyAtNode<D>& side : part.sides_of(node))
      part.for_each_place(
          side, [&](std::uint32_t place) { __builtin_prefetch(grid.nodes.record_at(place), 1); });
  };
  threads.for_each(contact.parts.size(), [&](std::size_t p) {
    ContactPart<D>& part = contact.parts[p];
    const std::size_t count = part.nodes.size();
    for (std::size_t n = 0; n < std::min(ahead, count); ++n) fetch(part, part.nodes[n]);
    for (std::size_t n = 0; n < count; ++n) {
      if (n + ahead < count) fetch(part, part.nodes[n + ahead]);
      if (part.any_gap_closed(part.nodes[n])) f(part, part.nodes[n]);
    }
  });
}

/// Write a vector at number `at` to all copies of the record of a side's node.
template <int D>
void write(TileGrid<D>& grid, const ContactPart<D>& part, const BodyAtNode<D>& side,
           const Vec<double, D>& value, int at) {
  part.for_each_place(side, [&](std::uint32_t place) {
    double* const numbers = grid.nodes.record_at(place);
    for (int a = 0; a < D; ++a) numbers[at + a] = value[a];
  });
}

/// Solve for the velocities at number `at` of the records where a pair is stopped, from what
/// `from(side)` gives; then f(sides, pairs, solution).
template <int D, class From, class F>
void for_each_stopped(Contact<D>& contact, TileGrid<D>& grid, int at, From&& from, Threads& threads,
                      F&& f) {
  const auto acts = [](const ContactPair<D>& pair) {
    return pair.bonded || (pair.stopped && pair.gap_closed);
  };
  for_each_gap_closed(contact, grid, threads, [&](ContactPart<D>& part, const ContactNode& node) {
    const auto sides = part.sides_of(node);
    const auto pairs = part.pairs_of(node);
    if (std::ranges::none_of(pairs, acts)) return;
    auto& solution = solution_of<D>(sides, pairs, acts);
    for (std::size_t k = 0; k < sides.size(); ++k)
      solution.sides[k].start(from(sides[k]), Vec<double, D>::zero());
    solve<false>(contact, solution);
    for (std::size_t k = 0; k < sides.size(); ++k)
      write(grid, part, sides[k], solution.sides[k].end_velocity(), at);
    f(sides, pairs, solution);
  });
}

/// f(part, side) for the bodies at these nodes that are bonded to none there.
template <int D, class F>
void for_each_free_side(Contact<D>& contact, TileGrid<D>& grid, Threads& threads, F&& f) {
  for_each_gap_closed(contact, grid, threads, [&](ContactPart<D>& part, const ContactNode& node) {
    const auto sides = part.sides_of(node);
    for (std::size_t k = 0; k < sides.size(); ++k)
      if (std::ranges::none_of(part.pairs_of(node), [&](const ContactPair<D>& pair) {
            return pair.bonded && (pair.r == k || pair.s == k);
          }))
        f(part, sides[k]);
  });
}

/// What the velocity of a prescribed body at a node changes by in this step [m/s].
template <int D>
Vec<double, D> prescribed_increment(const Contact<D>& contact, const TileGrid<D>& grid,
                                    const std::vector<Body<D>>& bodies, const ContactNode& node,
                                    const BodyAtNode<D>& side) {
  const Vec<double, D> x = grid.position_of(place_of(contact, grid, node));
  const Body<D>& body = bodies[static_cast<std::size_t>(side.body)];
  return from_space<D>(body.motion->increment_at(in_space<D>(x)));
}

/// The impulses of a solution for the pairs, with the work of friction; returns that with the slip
/// at the start of the step [J].
template <int D>
double take_impulses(TileGrid<D>& grid, std::span<const BodyAtNode<D>> sides,
                     const NodeSolution<D>& solution, std::span<ContactPair<D>> pairs) {
  double friction_first = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ContactPair<D>& pair = pairs[k];
    const SolvedPair<D>& solved = solution.pairs[k];
    pair.normal_impulse = solved.normal_impulse;
    pair.friction_impulse = solved.friction_impulse;
    pair.friction_first = pair.friction_work = 0.0;
    if (pair.bonded) continue;  // they do not slip
    // A constant force over the step meets a slip that changes linearly: the mean of both ends
    // gives its work exactly. The impulse is that on s and the slip is of r against s: what
    // friction takes is positive.
    const Vec<double, D> begin =
        read(grid, sides[pair.r], velocity_at) - read(grid, sides[pair.s], velocity_at);
    const Vec<double, D> end =
        solution.sides[pair.r].end_velocity() - solution.sides[pair.s].end_velocity();
    pair.friction_first = dot(solved.friction_impulse, begin);
    // By either of the two solutions: a pair that (6)-(7) have pushed is recorded even if no force
    // follows.
    pair.loaded = pair.loaded || solved.normal_impulse > 0.0;
    pair.friction_work = 0.5 * (pair.friction_first + dot(solved.friction_impulse, end));
    friction_first += pair.friction_first;
  }
  return friction_first;
}

/// Velocities and impulses from which the sides of a node start.
template <int D>
void start_forces(const Contact<D>& contact, TileGrid<D>& grid, const ContactStep<D>& step,
                  const ContactNode& node, std::span<const BodyAtNode<D>> sides,
                  NodeSolution<D>& solution) {
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Vec<double, D> velocity = read(grid, sides[k], velocity_at);
    if (sides[k].prescribed) {
      solution.sides[k].start(
          velocity + prescribed_increment(contact, grid, step.bodies, node, sides[k]),
          Vec<double, D>::zero());
      continue;
    }
    // Drag by the velocity in the middle of the step makes a body the more inert.
    solution.sides[k].mass *= 1.0 + step.damping_of(sides[k]).half_drag(step.time_step);
    solution.sides[k].start(velocity, impulse_alone(grid, step, node, sides[k]));
  }
}

}  // namespace

template <int D>
void remove_approach(Contact<D>& contact, TileGrid<D>& grid, Threads& threads) {
  // Without forces: eqs. (6)-(7) act on what was mapped.
  const auto mapped = [](const BodyAtNode<D>& side) { return side.mapped; };
  for_each_stopped(
      contact, grid, velocity_at, mapped, threads,
      [&](std::span<const BodyAtNode<D>> sides, std::span<ContactPair<D>> pairs,
          const NodeSolution<D>& solution) {
        for (std::size_t k = 0; k < pairs.size(); ++k) {
          ContactPair<D>& pair = pairs[k];
          if (pair.bonded || !pair.stopped) continue;
          // Of pairs that take no part the impulse is zero, so that they end up neither active nor
          // loaded.
          const bool pushed = solution.pairs[k].normal_impulse > 0.0;
          const Vec<double, D> relative =
              solution.sides[pair.r].end_velocity() - solution.sides[pair.s].end_velocity();
          // Bodies at rest against each other touch too, whatever the rounding of their velocities.
          const double rounding = 1e-13 * (norm(sides[pair.r].mapped) + norm(sides[pair.s].mapped));
          pair.active = pair.gap_closed && (pushed || dot(relative, pair.normal) >= -rounding);
          pair.loaded = pushed;
        }
      });
}

template <int D>
void add_contact_forces(Contact<D>& contact, TileGrid<D>& grid, const ContactStep<D>& step,
                        Threads& threads) {
  for_each_gap_closed(contact, grid, threads, [&](ContactPart<D>& part, ContactNode& node) {
    const auto sides = part.sides_of(node);
    const auto pairs = part.pairs_of(node);
    auto& solution =
        solution_of<D>(sides, pairs, [](const ContactPair<D>& pair) { return pair.active; });
    for (std::size_t k = 0; k < pairs.size(); ++k)
      solution.pairs[k].spring = spring_over(pairs[k].spring, step.time_step);
    start_forces<D>(contact, grid, step, node, sides, solution);
    solve<true>(contact, solution);
    if (contact.cache.on) move_gaps(part, node, solution, step.time_step);

    const double friction_first = take_impulses<D>(grid, sides, solution, pairs);
    for (const ContactPair<D>& pair : pairs) {
      if (!(pair.spring.stiffness > 0.0)) continue;
      const Vec<double, D> approach =
          solution.sides[pair.r].end_velocity() - solution.sides[pair.s].end_velocity();
      node.stored += pair.spring.energy_after(step.time_step * dot(approach, pair.normal));
    }
    double force_work = 0.0, correction = 0.0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const BodyAtNode<D>& side = sides[k];
      const Vec<double, D> velocity = read(grid, side, velocity_at);
      Vec<double, D> impulse = solution.sides[k].momentum;  // of the others
      if (!side.prescribed) {
        const PushedNode<D> pushed = pushed_node(grid, step, node, side, solution.sides[k]);
        impulse = pushed.impulse;
        // Forces change the particles' velocities, eq. (17), which have no part of the correction
        // by (6)-(7) (decision 0003): the work of the forces on that difference is lost or made by
        // contact.
        correction -= dot(pushed.own, velocity - side.mapped);
      }
      force_work += dot(impulse, velocity);
      part.for_each_place(side, [&](std::uint32_t place) {
        double* const numbers = grid.nodes.record_at(place);
        for (int a = 0; a < D; ++a) numbers[force_at + a] += (1.0 / step.time_step) * impulse[a];
      });
    }
    node.force_work = force_work;
    // For the ledger's `contact`: what contact takes at the velocities of the start, less friction
    // with the slip of the start, which has a column of its own.
    node.energy = -(force_work + correction) - friction_first;
  });
}

template <int D>
void find_slip(Contact<D>& contact, TileGrid<D>& grid, Threads& threads) {
  for_each_gap_closed(contact, grid, threads, [&](ContactPart<D>& part, const ContactNode& node) {
    const auto sides = part.sides_of(node);
    // The slip at the end of the step is that of the particles. The nodes' own increments, forces
    // over masses that may be next to nothing, reach the particles only in part.
    for (ContactPair<D>& pair : part.pairs_of(node)) {
      if (pair.bonded) continue;
      const Vec<double, D> slip =
          read(grid, sides[pair.r], remapped_at) - read(grid, sides[pair.s], remapped_at);
      pair.friction_work = 0.5 * (pair.friction_first + dot(pair.friction_impulse, slip));
    }
  });
}

template <int D>
void remove_remapped_approach(Contact<D>& contact, TileGrid<D>& grid, Threads& threads) {
  // The impulses of this solution act on the velocities that strain the material only; they are not
  // contact forces.
  const auto remapped = [&](const BodyAtNode<D>& side) { return read(grid, side, remapped_at); };
  for_each_stopped(contact, grid, remapped_at, remapped, threads, [](auto&&...) {});
}

template <int D>
void release_particles(Contact<D>& contact, TileGrid<D>& grid, Threads& threads) {
  for_each_free_side(contact, grid, threads, [&](ContactPart<D>& part, BodyAtNode<D>& side) {
    const Vec<double, D> free = side.mapped + read(grid, side, increment_at);
    side.mapped = read(grid, side, velocity_at);  // kept there until `restore_nodes`
    write(grid, part, side, free, velocity_at);
  });
}

template <int D>
void restore_nodes(Contact<D>& contact, TileGrid<D>& grid, Threads& threads) {
  for_each_free_side(contact, grid, threads, [&](ContactPart<D>& part, BodyAtNode<D>& side) {
    write(grid, part, side, side.mapped, velocity_at);
  });
}

template void remove_approach<2>(Contact<2>&, TileGrid<2>&, Threads&);
template void remove_approach<3>(Contact<3>&, TileGrid<3>&, Threads&);
template void add_contact_forces<2>(Contact<2>&, TileGrid<2>&, const ContactStep<2>&, Threads&);
template void add_contact_forces<3>(Contact<3>&, TileGrid<3>&, const ContactStep<3>&, Threads&);
template void find_slip<2>(Contact<2>&, TileGrid<2>&, Threads&);
template void remove_remapped_approach<2>(Contact<2>&, TileGrid<2>&, Threads&);
template void find_slip<3>(Contact<3>&, TileGrid<3>&, Threads&);
template void remove_remapped_approach<3>(Contact<3>&, TileGrid<3>&, Threads&);
template void release_particles<2>(Contact<2>&, TileGrid<2>&, Threads&);
template void release_particles<3>(Contact<3>&, TileGrid<3>&, Threads&);
template void restore_nodes<2>(Contact<2>&, TileGrid<2>&, Threads&);
template void restore_nodes<3>(Contact<3>&, TileGrid<3>&, Threads&);

}  // namespace mpm
