// What the surfaces of bodies do to each other at the end of a step, and to the bodies in the next.
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/surfaces/as_one.hpp"
#include "mpm/surfaces/between.hpp"
#include "mpm/surfaces/bonds.hpp"
#include "mpm/surfaces/host_motion.hpp"
#include "mpm/surfaces/near_points.hpp"
#include "mpm/surfaces/overlaps.hpp"
#include "mpm/surfaces/parts.hpp"
#include "mpm/surfaces/press.hpp"
#include "mpm/surfaces/restitution.hpp"

namespace mpm {
namespace {

/// What acts on the hosts, and on bodies that do not deform.
template <int D>
class Acting {
 public:
  explicit Acting(Surfaces<D>& surfaces) : surfaces_(surfaces) {
    for (const ActingOnHost<D>& one : surfaces_.on_hosts) surfaces_.place_on_hosts[one.host] = 0;
    surfaces_.on_hosts.clear();
    surfaces_.on_bodies.clear();
  }
  void push(std::uint32_t point, const Vec<double, D>& force) {
    const ContactPoint<D>& at = surfaces_.points[point];
    if (ActingOnBody* const body = body_of(at)) {
      body->push += in_space<D>(force);
      body->moment_of_push += cross(in_space<D>(surfaces_.places[point]), in_space<D>(force));
      return;
    }
    on(at.host).push.add(force, at.offset);
  }
  /// At a place that is at a reach from the point's host.
  void rub(std::uint32_t point, const Vec<double, D>& force, const Vec<double, D>& reach,
           const Vec<double, D>& place) {
    const ContactPoint<D>& at = surfaces_.points[point];
    if (ActingOnBody* const body = body_of(at)) {
      body->rub += in_space<D>(force);
      body->moment_of_rub += cross(in_space<D>(place), in_space<D>(force));
      return;
    }
    on(at.host).rub.add(force, reach);
  }
  void sort() {
    std::ranges::sort(surfaces_.on_hosts, {}, &ActingOnHost<D>::host);
    for (std::size_t k = 0; k < surfaces_.on_hosts.size(); ++k)
      surfaces_.place_on_hosts[surfaces_.on_hosts[k].host] = static_cast<std::uint32_t>(k + 1);
  }

 private:
  ActingOnHost<D>& on(std::uint32_t host) {
    std::uint32_t& place = surfaces_.place_on_hosts[host];
    if (place == 0) {
      surfaces_.on_hosts.push_back({host, {}, {}});
      place = static_cast<std::uint32_t>(surfaces_.on_hosts.size());
    }
    return surfaces_.on_hosts[place - 1];
  }
  /// None if the point's body deforms.
  ActingOnBody* body_of(const ContactPoint<D>& point) {
    const SurfacePart<D>& part = surfaces_.parts[surfaces_.hosts[point.host].part];
    if (!part.as_one) return nullptr;
    return &acting_on_body(surfaces_.on_bodies, part.body);
  }

  Surfaces<D>& surfaces_;
};

template <int D>
void give_to_hosts(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  Acting<D> acting(surfaces);
  surfaces.stored_push = surfaces.stored_rub = 0.0;
  surfaces.touching = 0;
  surfaces.deepest = {};
  for (const SurfacePart<D>& part : surfaces.parts) {
    surfaces.stored_push += part.stored_push;
    surfaces.stored_rub += part.stored_rub;
    for (const SurfaceTouch<D>& touch : part.touches) {
      if (!(touch.pushed > 0.0)) continue;
      ++surfaces.touching;
      const Vec<double, D> place = surfaces.places[touch.point] + touch.arm;
      if (!is_face(touch.opposite) && touch.overlap > surfaces.deepest.overlap)
        surfaces.deepest = {part.body, touch.overlap, place};
      const bool rubbed = rubs(touch);
      acting.push(touch.point, touch.push);
      if (rubbed) acting.rub(touch.point, touch.rub, touch.reach, place);
      const double push = touch.stiffness * touch.pushed;
      for (std::uint32_t k = 0; k < touch.felt; ++k) {
        const FeltPoint<D>& felt = part.felt[touch.first_felt + k];
        acting.push(felt.point, -push * felt.slope);
        if (rubbed)
          acting.rub(felt.point, -felt.share * touch.rub, reach_of(domain, felt.point, place),
                     place);
      }
    }
  }
  for (const Bond<D>& bond : surfaces.bonds) {
    surfaces.stored_push += 0.5 * dot(bond.pull, bond.pull) / bond.stiffness;
    acting.push(bond.first, bond.pull);
    acting.push(bond.second, -1.0 * bond.pull);
  }
  surfaces.touching_max = std::max(surfaces.touching_max, surfaces.touching);
  acting.sort();
}

/// The other half of the work of contact in the step, by the forces where the bodies are by now:
/// so that linear springs take what they store. They go on to drive the nodes to the end of the
/// step.
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

}  // namespace

template <int D>
void touch_surfaces(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!surfaces.exist()) return;
  if (surfaces.meet) record_between(domain);
  add_work_as_one(domain, false);
  move_points_as_one(domain);
  place_points(domain);
  if (surfaces.meet) find_near_points(domain);
  domain.threads.for_each(surfaces.parts.size(),
                          [&](std::size_t k) { find_overlaps(domain, surfaces.parts[k]); });
  pull_bonds(domain);
  find_motions(domain);
  domain.threads.for_each(surfaces.parts.size(),
                          [&](std::size_t k) { press_part(domain, surfaces.parts[k]); });
  give_to_hosts(domain);
  sum_between(domain);
  add_restitution(domain);
  add_work_as_one(domain, true);
  domain.threads.for_each(surfaces.parts.size(),
                          [&](std::size_t k) { add_work_at_end(domain, surfaces.parts[k]); });
}

template <int D>
void load_by_surfaces(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!surfaces.exist()) return;
  find_parts(domain);
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    for (const ActingOnHost<D>& on : acting_on(surfaces, part)) {
      ForceAtHost<D> all = on.push;
      all.add(on.rub);
      give_to_nodes_of(domain, surfaces.hosts[on.host], all);
    }
    if (!part.at_faces) return;
    const double acts = time_of_forces(domain, domain.grid.patches[part.patch]);
    domain.sums[part.patch].angular.walls += acts * part.moment_of_faces;
    domain.face_parts[part.patch].add(part.of_faces, acts);
  });
}

template void touch_surfaces<2>(Domain<2>&);
template void touch_surfaces<3>(Domain<3>&);
template void load_by_surfaces<2>(Domain<2>&);
template void load_by_surfaces<3>(Domain<3>&);

}  // namespace mpm
