#include "mpm/surfaces/press.hpp"

#include <algorithm>

#include "mpm/surfaces/across_walls.hpp"
#include "mpm/surfaces/approaches.hpp"
#include "mpm/surfaces/felt_motion.hpp"
#include "mpm/surfaces/law.hpp"
#include "mpm/surfaces/levelled.hpp"
#include "mpm/surfaces/overlaps.hpp"
#include "mpm/surfaces/parts.hpp"
#include "mpm/surfaces/restitution.hpp"

namespace mpm {
namespace {

/// w of a touch that begins: no more than it has begun since the step before. One that has just
/// parted from a shorter spring would be pushed at once.
template <int D>
double onset_now(const Domain<D>& domain, const SurfacePart<D>& part, const SurfaceTouch<D>& touch,
                 double approach) {
  const double begun = 2.0 * (approach * domain.time_step - touch.overlap);
  return std::clamp(begun, 0.0, onset_of(domain, part, touch.opposite, approach));
}

template <int D>
double friction_with(const Domain<D>& domain, int body, Opposite opposite) {
  if (is_wall(opposite))
    return domain.grid.walls_of(body).friction[axis_of_wall(opposite)][side_of_wall(opposite)];
  return law_of(domain.contact_settings, domain.body_at(body).group, domain.body_at(opposite).group)
      .friction;
}

/// The velocity of a point's body against the other's at the place of contact.
template <int D>
Vec<double, D> slip_velocity(const Domain<D>& domain, const SurfacePart<D>& part,
                             const SurfaceTouch<D>& touch) {
  const Vec<double, D> place = domain.surfaces.places[touch.point] + touch.arm;
  return velocity_of_point(domain, touch.point, touch.reach, place) -
         velocity_of_felt<D>(domain, felt_by(touch, part.felt), place);
}

/// How fast the surfaces of a touch approach each other that slip with u on each other [m/s].
template <int D>
double approach_of(const SurfaceTouch<D>& touch, const Vec<double, D>& u) {
  return std::max(-dot(touch.slope, u), 0.0);
}

/// What waves meet in a body, 1 / (rho c) of the start [m^2 s/kg].
template <int D>
double admittance_of(const Domain<D>& domain, int body) {
  const Body<D>& of = domain.body_at(body);
  return 1.0 / std::sqrt(of.stiffness * of.initial_density);
}
/// (S6)
template <int D>
double damping_of(const Domain<D>& domain, const SurfacePart<D>& part,
                  const SurfaceTouch<D>& touch) {
  const double area = domain.surfaces.points[touch.point].area,
               own = admittance_of(domain, part.body);
  return is_wall(touch.opposite)
             ? damping_at_wall(area, own)
             : damping_of_point(area, own, admittance_of(domain, touch.opposite));
}

/// The force of friction of a touch of which the surfaces slip with u on each other, and of the
/// dashpot along the normal if it slides; `before`: the slip so far.
template <int D>
Friction<D> slide(const Domain<D>& domain, const SurfacePart<D>& part, SurfaceTouch<D>& touch,
                  const Vec<double, D>& before, const Vec<double, D>& u, double coefficient) {
  const double push = norm(touch.push);
  const Vec<double, D> normal = (1.0 / push) * touch.push, way = domain.time_step * u;
  const auto friction_with = [&](double force) {
    return rub(before, normal, way, touch.stiffness, coefficient, force);
  };
  const Friction<D> friction = friction_with(push);
  if (!friction.slides) return friction;
  const double along = dot(normal, u), damping = slides_by(along, norm(u - along * normal)) *
                                                 damping_of(domain, part, touch);
  touch.pressed_in = std::max(touch.pressed_in - damping / touch.stiffness * dot(touch.slope, u),
                              least_push * touch.pressed_in);
  touch.push = touch.stiffness * touch.pressed_in * touch.slope;
  return friction_with(norm(touch.push));
}

}  // namespace

template <int D>
void find_motions(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  for (const std::uint32_t host : surfaces.moving) surfaces.place_of_motion[host] = 0;
  surfaces.moving.clear();
  const auto needs = [&](std::uint32_t point) {
    const std::uint32_t host = surfaces.points[point].host;
    const SurfacePart<D>& part = surfaces.parts[surfaces.hosts[host].part];
    if (part.as_one || part.foreign || surfaces.place_of_motion[host] != 0) return;
    surfaces.moving.push_back(host);
    surfaces.place_of_motion[host] = static_cast<std::uint32_t>(surfaces.moving.size());
  };
  for (const SurfacePart<D>& part : surfaces.parts) {
    if (part.foreign) continue;
    for (const SurfaceTouch<D>& touch : part.touches) needs(touch.point);
    for (const FeltPoint<D>& felt : part.felt) needs(felt.point);
  }
  for (const PressingPatch<D>& of : surfaces.pressing)
    for (const FeltPoint<D>& felt : of.felt) needs(felt.point);
  surfaces.in_touch.resize(surfaces.moving.size());
  domain.threads.for_each(surfaces.moving.size(), [&](std::size_t k) {
    const Host<D>& host = surfaces.hosts[surfaces.moving[k]];
    surfaces.in_touch[k] = {motion_of<velocity_at>(domain, host),
                            HostDeformation<D>(deformation_of(domain, host))};
  });
}

template <int D>
void set_back_onsets(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  for_each_own_part(domain, [&](SurfacePart<D>& part) { find_overlaps(domain, part); });
  find_motions(domain);
  const auto less = std::less<KeptOfContact<double>>{};
  std::vector<KeptOfContact<double>> more;
  for (SurfacePart<D>& part : surfaces.parts) {
    if (part.foreign) continue;
    for (SurfaceTouch<D>& touch : part.touches) {
      touch.reach = reach_of(domain, touch.point, surfaces.places[touch.point] + touch.arm);
      const double approach = approach_of(touch, slip_velocity(domain, part, touch)),
                   begun = touch.overlap + 0.5 * onset_of(domain, part, touch.opposite, approach);
      if (begun > 0.0) more.push_back({touch.point, touch.opposite, begun});
    }
  }
  std::vector<KeptOfContact<double>>& all = surfaces.set_back;
  const auto known = static_cast<std::ptrdiff_t>(all.size());
  for (const KeptOfContact<double>& one : more) {
    const auto at = std::lower_bound(all.begin(), all.begin() + known, one, less);
    if (at != all.begin() + known && !less(one, *at))
      at->value += one.value;
    else
      all.push_back(one);
  }
  std::ranges::sort(all, less);
}

template <int D>
void press_part(Domain<D>& domain, SurfacePart<D>& part) {
  const Surfaces<D>& surfaces = domain.surfaces;
  part.kept_next.clear();
  part.begun.clear();
  part.stored_push = part.stored_rub = 0.0;
  part.by_walls = {};
  part.moment_by_walls = Vector3::zero();
  part.at_walls = false;
  const bool takes = restitution_takes(domain.contact_settings);
  for (SurfaceTouch<D>& touch : part.touches) {
    touch.reach = reach_of(domain, touch.point, surfaces.places[touch.point] + touch.arm);
    touch.rub = Vec<double, D>::zero();
    touch.pressed_in = 0.0;
    double mu = friction_with(domain, part.body, touch.opposite);
    if (takes && mu > 0.0) mu *= left_by_restitution(domain, part.body, touch.opposite);
    const MemoryOfTouch<D>* const known = find_kept(part.kept, touch.point, touch.opposite);
    Levelled<D>* const levelled = find_kept(part.levelled, touch.point, touch.opposite);
    const bool must_know_slip = !known || mu > 0.0 || levelled;
    const Vec<double, D> u =
        must_know_slip ? slip_velocity(domain, part, touch) : Vec<double, D>::zero();
    const double approach = approach_of(touch, u);
    MemoryOfTouch<D> memory;
    if (known)
      memory = *known;
    else
      memory.onset = onset_now(domain, part, touch, approach);
    if (!(touch.overlap > -0.5 * memory.onset)) continue;
    if (!known) part.begun.emplace_back(touch.opposite, approach);
    if (levelled) go_on(*levelled, domain.time_step * u, normalised(touch.slope));
    touch.pressed_in = pressed_in_by(touch.overlap, memory.onset);
    touch.push = touch.stiffness * touch.pressed_in * touch.slope;
    part.stored_push += touch.stiffness * stored_by(touch.overlap, memory.onset);
    if (mu > 0.0 && norm(touch.push) > 0.0) {
      const Friction<D> friction = slide(domain, part, touch, memory.slip, u, mu);
      touch.rub = friction.force;
      touch.rub_work = friction.taken;
      part.stored_rub += friction.stored;
      memory.slip = friction.slip;
    }
    part.kept_next.push_back({touch.point, touch.opposite, memory});
    if (!is_wall(touch.opposite)) {
      for (std::uint32_t k = touch.first_felt; k < touch.first_felt + touch.felt_count; ++k)
        if (part.felt[k].mirrors != 0)
          add_across_walls(domain, surfaces.places[touch.point], touch, part.felt[k], part);
      continue;
    }
    part.at_walls = true;
    const Vec<double, D> force = touch.push + touch.rub;
    const unsigned face = 1u << (-1 - touch.opposite);
    for (int a = 0; a < D; ++a) part.by_walls.add(face, a, force[a]);
    part.moment_by_walls +=
        cross(in_space<D>(surfaces.places[touch.point] + touch.arm), in_space<D>(force));
  }
  std::swap(part.kept, part.kept_next);
}

template void find_motions<2>(Domain<2>&);
template void find_motions<3>(Domain<3>&);
template void set_back_onsets<2>(Domain<2>&);
template void set_back_onsets<3>(Domain<3>&);
template void press_part<2>(Domain<2>&, SurfacePart<2>&);
template void press_part<3>(Domain<3>&, SurfacePart<3>&);

}  // namespace mpm
