// What contact does at the nodes: velocities, forces, remapped velocities.
#include <algorithm>

#include "mpm/contact/contact_grid.hpp"

namespace mpm {

template <int D>
bool ContactGrid<D>::any_closed(const ContactNode& node) const {
  const SidePair<D>* pairs = &pairs_[node.first_pair];
  return std::any_of(pairs, pairs + pair_count(node.sides),
                     [](const SidePair<D>& pair) { return pair.closed; });
}

template <int D>
void ContactGrid<D>::adjust_momentum(TileGrid<D>& grid, Threads& threads) {
  threads.for_each(nodes_.size(), [&](std::size_t n) {
    const ContactNode& node = nodes_[n];
    if (!any_closed(node)) return;
    Side<D>* sides = &sides_[node.first_side];
    SidePair<D>* pairs = &pairs_[node.first_pair];
    const std::uint32_t count = pair_count(node.sides);
    for (std::uint32_t k = 0; k < node.sides; ++k)
      sides[k].start(sides[k].mapped, Vec<double, D>::zero());
    const bool converged = solve_node<D, false>(
        sides, pairs, count, [](const SidePair<D>& pair) { return pair.closed; });
    if (!converged) unconverged_.fetch_add(1, std::memory_order_relaxed);
    for (std::uint32_t k = 0; k < node.sides; ++k) {
      Side<D>& side = sides[k];
      side.velocity = side.end_velocity();
      for_each_copy(grid, node, side, [&](std::size_t p, int at) {
        for (int a = 0; a < D; ++a) grid.block(p).velocity(a)[at] = side.velocity[a];
      });
    }
    for (std::uint32_t k = 0; k < count; ++k) {
      SidePair<D>& pair = pairs[k];
      const Side<D>& r = sides[pair.r];
      const Side<D>& s = sides[pair.s];
      // Bodies at rest against each other touch too, whatever the rounding of their velocities.
      const double rounding = 1e-13 * (norm(r.mapped) + norm(s.mapped));
      pair.touching = pair.closed && (pair.normal_impulse > 0.0 ||
                                      dot(r.velocity - s.velocity, pair.normal) >= -rounding);
      pair.acted = pair.normal_impulse > 0.0;
    }
  });
}

/// Gravity along the axes that no wall holds at a node.
template <int D>
Vec<double, D> free_gravity(const ContactNode& node, Vec<double, D> gravity) {
  for (int a = 0; a < D; ++a)
    if (node.held >> a & 1u) gravity[a] = 0.0;
  return gravity;
}

template <int D>
void ContactGrid<D>::add_forces(TileGrid<D>& grid, const Vec<double, D>& gravity, double time_step,
                                Threads& threads) {
  threads.for_each(nodes_.size(), [&](std::size_t n) {
    ContactNode& node = nodes_[n];
    if (!any_closed(node)) return;
    Side<D>* sides = &sides_[node.first_side];
    SidePair<D>* pairs = &pairs_[node.first_pair];
    const std::uint32_t count = pair_count(node.sides);
    auto force_of = [&](const Side<D>& side) {
      Vec<double, D> f = Vec<double, D>::zero();
      bool read = false;
      for_each_copy(grid, node, side, [&](std::size_t p, int at) {
        if (read) return;
        for (int a = 0; a < D; ++a)
          f[a] = node.held >> a & 1u ? 0.0 : grid.block(p).force(a)[at] + side.mass * gravity[a];
        read = true;
      });
      return f;
    };
    for (std::uint32_t k = 0; k < node.sides; ++k) {
      Side<D>& side = sides[k];
      if (side.prescribed)
        side.start(side.velocity + side.increment, Vec<double, D>::zero());
      else
        side.start(side.velocity, time_step * force_of(side));
    }
    const bool converged = solve_node<D, true>(
        sides, pairs, count, [](const SidePair<D>& pair) { return pair.touching; });
    if (!converged) unconverged_.fetch_add(1, std::memory_order_relaxed);

    double force_work = 0.0, correction = 0.0;
    for (std::uint32_t k = 0; k < node.sides; ++k) {
      const Side<D>& side = sides[k];
      Vec<double, D> contact = side.momentum;  // impulse of the others
      if (!side.prescribed) {
        const Vec<double, D> change = side.momentum - side.mass * side.velocity;  // of all forces
        contact = change - time_step * force_of(side);
        // The node itself has its own mass only.
        const Vec<double, D> own =
            change - (time_step * (side.mass - side.mapped_mass)) * free_gravity(node, gravity);
        correction -= dot(own, side.velocity - side.mapped);
      }
      force_work += dot(contact, side.velocity);
      for_each_copy(grid, node, side, [&](std::size_t p, int at) {
        for (int a = 0; a < D; ++a) grid.block(p).force(a)[at] += (1.0 / time_step) * contact[a];
      });
    }
    double friction_first = 0.0;
    for (std::uint32_t k = 0; k < count; ++k) {
      SidePair<D>& pair = pairs[k];
      const Side<D>& r = sides[pair.r];
      const Side<D>& s = sides[pair.s];
      const Vec<double, D> end = r.end_velocity() - s.end_velocity();
      pair.friction_first = dot(pair.friction_impulse, r.velocity - s.velocity);
      pair.acted = pair.acted || pair.normal_impulse > 0.0;
      pair.impulse = -pair.normal_impulse * pair.normal - pair.friction_impulse;
      pair.friction_work = 0.5 * (pair.friction_first + dot(pair.friction_impulse, end));
      friction_first += pair.friction_first;
    }
    node.force_work = force_work;
    node.energy = -(force_work + correction) - friction_first;
  });
}

template <int D>
void ContactGrid<D>::adjust_remapped(TileGrid<D>& grid, Threads& threads) {
  threads.for_each(nodes_.size(), [&](std::size_t n) {
    const ContactNode& node = nodes_[n];
    if (!any_closed(node)) return;
    Side<D>* sides = &sides_[node.first_side];
    for (std::uint32_t k = 0; k < node.sides; ++k) {
      Side<D>& side = sides[k];
      Vec<double, D> remapped = Vec<double, D>::zero();
      for_each_copy(grid, node, side, [&](std::size_t p, int at) {
        for (int a = 0; a < D; ++a) remapped[a] = grid.block(p).force(a)[at];
      });
      side.start(remapped, Vec<double, D>::zero());
    }
    // The impulses of this solution act on the velocities that strain the material only; they are
    // not contact forces.
    SidePair<D>* pairs = &pairs_[node.first_pair];
    const bool converged = solve_node<D, false>(
        sides, pairs, pair_count(node.sides), [](const SidePair<D>& pair) { return pair.closed; });
    if (!converged) unconverged_.fetch_add(1, std::memory_order_relaxed);
    for (std::uint32_t k = 0; k < node.sides; ++k) {
      const Vec<double, D> velocity = sides[k].end_velocity();
      for_each_copy(grid, node, sides[k], [&](std::size_t p, int at) {
        for (int a = 0; a < D; ++a) grid.block(p).force(a)[at] = velocity[a];
      });
    }
  });
}

template void ContactGrid<2>::adjust_momentum(TileGrid<2>&, Threads&);
template void ContactGrid<3>::adjust_momentum(TileGrid<3>&, Threads&);
template void ContactGrid<2>::add_forces(TileGrid<2>&, const Vec<double, 2>&, double, Threads&);
template void ContactGrid<3>::add_forces(TileGrid<3>&, const Vec<double, 3>&, double, Threads&);
template void ContactGrid<2>::adjust_remapped(TileGrid<2>&, Threads&);
template void ContactGrid<3>::adjust_remapped(TileGrid<3>&, Threads&);

}  // namespace mpm
