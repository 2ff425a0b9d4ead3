// What the surfaces of bodies do to each other at the end of a step, and to the bodies in the next.
#include <array>
#include <numeric>

#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/surfaces/acting.hpp"
#include "mpm/surfaces/approaches.hpp"
#include "mpm/surfaces/between.hpp"
#include "mpm/surfaces/bonds.hpp"
#include "mpm/surfaces/host_motion.hpp"
#include "mpm/surfaces/mirrored.hpp"
#include "mpm/surfaces/near_points.hpp"
#include "mpm/surfaces/overlaps.hpp"
#include "mpm/surfaces/parts.hpp"
#include "mpm/surfaces/press.hpp"
#include "mpm/surfaces/pressing.hpp"
#include "mpm/surfaces/restitution.hpp"
#include "mpm/surfaces/tell_others.hpp"

namespace mpm {
namespace {

/// f(given) for what the touches of an own part give to points of other bodies.
template <int D, class F>
void for_each_felt(const Domain<D>& domain, std::size_t number, const SurfaceTouch<D>& touch,
                   F&& f) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const TileGrid<D>& grid = domain.grid;
  const SurfacePart<D>& part = surfaces.parts[number];
  const Vec<double, D> place = surfaces.places[touch.point] + touch.arm;
  const double push = touch.stiffness * touch.pressed_in;
  for (std::uint32_t k = touch.first_felt; k < touch.first_felt + touch.felt_count; ++k) {
    const FeltPoint<D>& felt = part.felt[k];
    f(GivenToPoint<D>{number, felt.point, rubs(touch), -push * felt.slope,
                      mirrored(felt.mirrors, -felt.share * touch.rub),
                      mirrored_place(grid, felt.mirrors, place)});
  }
}

/// f(bond, its part's place behind all parts) for bonds of own points.
template <int D, class F>
void for_each_own_bond(const Surfaces<D>& surfaces, F&& f) {
  for (const Bond<D>& bond : surfaces.bonds) {
    const SurfacePart<D>& part = part_of_point(surfaces, bond.first);
    const auto number = static_cast<std::size_t>(&part - surfaces.parts.data());
    if (!part.foreign) f(bond, surfaces.parts.size() + number);
  }
}

template <int D>
GivenToPoint<D> other_end(const Bond<D>& bond, std::uint64_t order) {
  const Vec<double, D> none = Vec<double, D>::zero();
  return {order, bond.second, false, -1.0 * bond.pull, none, none};
}

/// What touches and bonds of other ranks give to points of this one, by order.
template <int D>
std::vector<GivenToPoint<D>> given_by_others(Domain<D>& domain, const Acting<D>& acting) {
  Comm& comm = *domain.grid.partition.comm;
  const Surfaces<D>& surfaces = domain.surfaces;
  std::vector<GivenToPoint<D>> all;
  if (comm.alone()) return all;
  Mail mail;
  const auto send = [&](const GivenToPoint<D>& given) {
    if (acting.is_elsewhere(given.point))
      write(letter_to(mail, part_of_point(surfaces, given.point).rank), given);
  };
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k) {
    if (surfaces.parts[k].foreign) continue;
    for (const SurfaceTouch<D>& touch : surfaces.parts[k].touches)
      if (touch.pressed_in > 0.0) for_each_felt(domain, k, touch, send);
  }
  for_each_own_bond(
      surfaces, [&](const Bond<D>& bond, std::uint64_t order) { send(other_end(bond, order)); });
  for (const PressingPatch<D>& of : surfaces.pressing) for_each_given(domain, of, send);
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();)
      all.push_back(reader.template read<GivenToPoint<D>>());
  std::ranges::stable_sort(all, {}, &GivenToPoint<D>::order);
  return all;
}

/// Of the touches of an own part; returns how many there are.
template <int D>
std::size_t give_touches(Acting<D>& acting, const Domain<D>& domain, std::size_t number) {
  const Surfaces<D>& surfaces = domain.surfaces;
  std::size_t touching = 0;
  for (const SurfaceTouch<D>& touch : surfaces.parts[number].touches) {
    if (!(touch.pressed_in > 0.0)) continue;
    ++touching;
    acting.push(number, touch.point, touch.push);
    if (rubs(touch))
      acting.rub(number, touch.point, touch.rub, touch.reach,
                 surfaces.places[touch.point] + touch.arm);
    for_each_felt(domain, number, touch, [&](const GivenToPoint<D>& given) {
      if (!acting.is_elsewhere(given.point)) acting.give(given);
    });
  }
  return touching;
}

/// What particles give to surfaces, by tiles, whichever ranks have these. Returns how many touch.
template <int D, class F>
std::size_t give_pressing(Acting<D>& acting, const Domain<D>& domain, F&& give_until) {
  const std::vector<PressingPatch<D>>& all = domain.surfaces.pressing;
  thread_local std::vector<std::uint32_t> sorted;  // a step must not allocate
  sorted.resize(all.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::ranges::sort(sorted, {}, [&](std::uint32_t k) { return std::pair(all[k].order, k); });
  std::size_t touching = 0;
  for (const std::uint32_t k : sorted) {
    if (all[k].touches.empty()) continue;
    give_until(all[k].order - 1);
    for_each_given(domain, all[k], [&](const GivenToPoint<D>& given) {
      if (!acting.is_elsewhere(given.point)) acting.give(given);
    });
    touching += static_cast<std::size_t>(std::ranges::count_if(
        all[k].touches, [](const PressingTouch<D>& touch) { return touch.pressed_in > 0.0; }));
  }
  return touching;
}

/// What is stored and how many touch, of all ranks, and what is deepest.
template <int D>
void sum_up(Domain<D>& domain, std::size_t touching) {
  Surfaces<D>& surfaces = domain.surfaces;
  Comm& comm = *domain.grid.partition.comm;
  std::array<ExactSum, 2> stored;
  DeepestOfRank<D> deepest;
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    if (part.foreign) continue;
    stored[0].add(part.stored_push);
    stored[1].add(part.stored_rub);
    for (const SurfaceTouch<D>& touch : part.touches)
      if (touch.pressed_in > 0.0 && !is_wall(touch.opposite) &&
          touch.overlap > deepest.point.overlap)
        deepest = {k, {part.body, touch.overlap, surfaces.places[touch.point] + touch.arm}};
  }
  for (const PressingPatch<D>& of : surfaces.pressing) {
    stored[0].add(of.stored_push);
    stored[1].add(of.stored_rub);
    const Patch<D>& patch = domain.grid.patches[of.patch];
    for (const PressingTouch<D>& touch : of.touches)
      if (touch.pressed_in > 0.0 && touch.sunk > deepest.point.overlap)
        deepest = {
            of.order,
            {patch.body, touch.sunk, domain.pool_of(patch).position_of(touch.row) + touch.arm}};
  }
  for (const Bond<D>& bond : surfaces.bonds)
    if (!part_of_point(surfaces, bond.first).foreign)
      stored[0].add(0.5 * dot(bond.pull, bond.pull) / bond.stiffness);
  all_sum(comm, stored);
  surfaces.stored_push = stored[0].value();
  surfaces.stored_rub = stored[1].value();
  surfaces.deepest = {};
  std::uint64_t at = 0;
  std::vector<DeepestOfRank<D>>& all = surfaces.deepest_of_all;
  all.assign(1, deepest);
  entries_of_all(comm, all);
  for (const DeepestOfRank<D>& one : all) {
    const double overlap = one.point.overlap;
    if (overlap < surfaces.deepest.overlap || !(overlap > 0.0)) continue;
    if (overlap == surfaces.deepest.overlap && one.part > at) continue;
    surfaces.deepest = one.point;
    at = one.part;
  }
  surfaces.touching = static_cast<std::size_t>(all_sum(comm, static_cast<std::int64_t>(touching)));
  surfaces.touching_max = std::max(surfaces.touching_max, surfaces.touching);
}

template <int D>
void give_to_hosts(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  Acting<D> acting(domain);
  const std::vector<GivenToPoint<D>> others = given_by_others(domain, acting);
  auto next = others.begin();
  const auto give_until = [&](std::uint64_t order) {
    for (; next != others.end() && next->order <= order; ++next) acting.give(*next);
  };
  std::size_t touching = 0;
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k) {
    give_until(k);
    if (!surfaces.parts[k].foreign) touching += give_touches(acting, domain, k);
  }
  for_each_own_bond(surfaces, [&](const Bond<D>& bond, std::uint64_t order) {
    give_until(order);
    acting.push(order, bond.first, bond.pull);
    const GivenToPoint<D> other = other_end(bond, order);
    if (!acting.is_elsewhere(other.point)) acting.give(other);
  });
  touching += give_pressing(acting, domain, give_until);
  give_until(std::numeric_limits<std::uint64_t>::max());
  acting.finish();
  sum_up(domain, touching);
}

/// The other half of the work of contact in the step, by the forces where the bodies are by now:
/// so that linear springs take what they store. Nodes have the velocities of the middle of the
/// step; what these forces do until its end is added to kept_ahead.
template <int D>
void add_work_at_end(Domain<D>& domain, const SurfacePart<D>& part) {
  if (part.as_one) return;
  PatchSums<D>& sums = domain.sums[part.patch];
  for (const ActingOnHost<D>& on : acting_on(domain.surfaces, part)) {
    const HostMotion<D> motion = motion_of<velocity_at>(domain, domain.surfaces.hosts[on.host]);
    const double push = 0.5 * domain.time_step * motion.power(on.push),
                 rub = 0.5 * domain.time_step * motion.power(on.rub);
    sums.surface_push += push;
    sums.surface_rub += rub;
    sums.kept_ahead += push + rub;
    sums.force_work -= push + rub;
    sums.kept_shift += push + rub;
  }
}

/// What the touches of a part pass to walls of the box, among the sums of a patch.
template <int D>
void add_by_walls(Domain<D>& domain, const SurfacePart<D>& part, std::size_t patch) {
  const double acts = time_of_forces(domain, true);
  domain.sums[patch].angular.walls += acts * part.moment_by_walls;
  domain.face_parts[patch].add(part.by_walls, acts);
}

/// What particles were pushed with goes to their nodes, and what walls took part in.
template <int D>
void load_by_all_particles(Domain<D>& domain) {
  for_each_patch(domain, deformable, [&](std::size_t p) { load_by_particles(domain, p); });
  const PressedWalls<D>& walls = domain.surfaces.pressed_walls;
  if (!walls.any) return;
  if (domain.sums.empty()) domain.sums.resize(1);
  if (domain.face_parts.empty()) domain.face_parts.resize(1);
  const double acts = time_of_forces(domain, true);
  domain.sums[0].angular.walls += acts * walls.moment;
  domain.face_parts[0].add(walls.faces, acts);
}

}  // namespace

template <int D>
void touch_surfaces(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!surfaces.exist()) return;
  if (surfaces.meet) record_between(domain);
  if (restitution_takes(domain.contact_settings)) tell_motions(domain);
  add_work_as_one(domain, false);
  move_points_as_one(domain);
  place_points(domain);
  if (surfaces.meet) find_near_points(domain);
  bound_onsets(domain);
  for_each_own_part(domain, [&](SurfacePart<D>& part) { find_overlaps(domain, part); });
  const bool pressed = particles_press(domain);
  if (pressed) find_pressing(domain);
  if (pressed) ask_for_pressed(domain);
  pull_bonds(domain);
  find_motions(domain);
  for_each_own_part(domain, [&](SurfacePart<D>& part) { press_part(domain, part); });
  if (pressed) press_particles(domain);
  learn_approaches(domain);
  give_to_hosts(domain);
  sum_between(domain);
  add_restitution(domain);
  add_work_as_one(domain, true);
  for_each_own_part(domain, [&](SurfacePart<D>& part) { add_work_at_end(domain, part); });
}

template <int D>
void load_by_surfaces(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!surfaces.exist()) return;
  find_parts(domain);
  for_each_own_part(domain, [&](SurfacePart<D>& part) {
    for (const ActingOnHost<D>& on : acting_on(surfaces, part)) {
      ForceAtHost<D> all = on.push;
      all.add(on.rub);
      give_to_nodes_of(domain, surfaces.hosts[on.host], all);
    }
    if (part.at_walls && !part.as_one) add_by_walls(domain, part, part.patch);
  });
  if (particles_press(domain)) load_by_all_particles(domain);
  // These have no patch of their own and count with the first, which this rank may not have.
  for (const SurfacePart<D>& part : surfaces.parts) {
    if (!part.at_walls || !part.as_one || part.foreign) continue;
    if (domain.sums.empty()) domain.sums.resize(1);
    if (domain.face_parts.empty()) domain.face_parts.resize(1);
    add_by_walls(domain, part, 0);
  }
}

template void touch_surfaces<2>(Domain<2>&);
template void touch_surfaces<3>(Domain<3>&);
template void load_by_surfaces<2>(Domain<2>&);
template void load_by_surfaces<3>(Domain<3>&);

}  // namespace mpm
