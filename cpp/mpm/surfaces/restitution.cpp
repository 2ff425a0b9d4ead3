// Restitution e between two bodies that touch (after Walton & Braun 1986): of the normal force N of
// the springs the bodies feel e^2 N as they part, so that of the energy that they gave e^2 comes
// back, whatever the law of the force. The rest, (1 - e^2) N, acts between their motions as wholes,
// at the middle of the contact, so that no wave is made:
//   F_n = - (1 - e^2) N min(u_n / u_s, 1)  if u_n > 0,   u_s = N dt / m*,
// u being that of the rigid motions there and u_s what keeps a contact from trembling: of twelve
// neighbours the six that part damp at most what can be taken in a step. At rest nothing acts, so
// that bodies bear what lies on them and no more.
// Along the surface a dashpot takes what swings on friction that sticks, 2 beta (k m*)^(1/2) u_t up
// to what Coulomb's law leaves, with beta of the linear dashpot of that restitution (Tsuji, Tanaka
// & Ishida 1992) and k of the springs.
#include "mpm/surfaces/restitution.hpp"

#include <algorithm>
#include <numbers>

#include "mpm/surfaces/as_one.hpp"

namespace mpm {
namespace {

// Of the momentum of two bodies along the surface what a contact may take in a step. Spheres that
// turn against twelve neighbours take twenty times as much, 2 x 12 x 2 / 3 / (2 x 0.4), and twice
// their spin would be too much.
constexpr double most_in_step = 0.05;

/// 1 / mass of a body; 0 of those whose motion is prescribed, and of faces.
template <int D>
double lightness(const Domain<D>& domain, Opposite number) {
  if (is_wall(number) || domain.body_at(number).is_prescribed()) return 0.0;
  return 1.0 / domain.body_at(number).total_mass;
}

template <int D>
PairLaw law_between(const Domain<D>& domain, const ActingBetween<D>& pair) {
  const ContactSettings& settings = domain.contact_settings;
  if (!is_wall(pair.b))
    return law_of(settings, domain.body_at(pair.a).group, domain.body_at(pair.b).group);
  const Walls<D>& walls = domain.grid.walls_of(pair.a);
  const double friction = walls.friction[axis_of_wall(pair.b)][side_of_wall(pair.b)];
  return {friction, false, 0.0, settings.restitution};
}

template <int D>
Vector3 velocity_at_place(const Domain<D>& domain, Opposite number, const Vector3& place) {
  return is_wall(number) ? Vector3::zero() : motion_as_one(domain, number).velocity_at(place);
}

/// `rub`: what friction of points has too much.
void add_at(std::vector<ActingOnBody>& all, int body, const Vector3& taking, const Vector3& rub,
            const Vector3& place) {
  ActingOnBody& on = acting_on_body(all, body);
  on.restitution.add(taking, place);
  on.rub.add(rub, place);
}

/// What a face gives a body as a whole is told with what it gives its points.
template <int D>
void add_by_wall(Surfaces<D>& surfaces, const ActingBetween<D>& pair, const Vector3& force,
                 const Vector3& place) {
  SurfacePart<D>& part =
      *std::ranges::lower_bound(surfaces.parts, pair.a, {}, &SurfacePart<D>::body);
  if (part.foreign) return;
  const unsigned face = 1u << (-1 - pair.b);
  for (int a = 0; a < D; ++a) part.by_walls.add(face, a, force[a]);
  part.moment_by_walls += cross(place, force);
  part.at_walls = true;
}

}  // namespace

template <int D>
void add_restitution(Domain<D>& domain) {
  if (!restitution_takes(domain.contact_settings)) return;
  Surfaces<D>& surfaces = domain.surfaces;
  const double dt = domain.time_step;
  const auto flows = [&](Opposite number) {
    return !is_wall(number) && domain.body_at(number).kind == BodyKind::deformable;
  };
  for (ActingBetween<D>& pair : surfaces.between) {
    if (flows(pair.a) || flows(pair.b)) continue;  // what it loses is its matter's own
    const PairLaw law = law_between(domain, pair);
    const double light = lightness(domain, pair.a) + lightness(domain, pair.b);
    const double e = law.restitution, push = norm(pair.push);
    if (!(e < 1.0 && push > 0.0 && light > 0.0 && dt > 0.0)) continue;
    const double mass = 1.0 / light;
    const Vector3 normal = (1.0 / push) * in_space<D>(pair.push);
    const Vector3 place = (1.0 / pair.size) * in_space<D>(pair.middle);
    const Vector3 u =
        velocity_at_place(domain, pair.a, place) - velocity_at_place(domain, pair.b, place);
    const double parting = dot(u, normal);
    const double slow = push * dt / mass;
    const double taken = (1.0 - e * e) * push * std::clamp(parting / slow, 0.0, 1.0);
    const Vector3 along = u - parting * normal;
    const double swing = norm(along), log_e = std::log(std::max(e, 1e-3));
    const double beta = -log_e / std::sqrt(std::numbers::pi * std::numbers::pi + log_e * log_e);
    const double rubbed = norm(pair.on_first - pair.push);
    const double most = std::max(law.friction * (push - taken) - rubbed, 0.0);
    const double drag =
        std::min(2.0 * beta * std::sqrt(pair.stiffness * mass), most_in_step * mass / dt) * swing;
    Vector3 taking = -taken * normal;
    if (swing > 0.0) taking -= (std::min(drag, most) / swing) * along;
    // Friction of points is bounded by what was left in the step before: what it is more by now.
    // What bonds pull is no friction.
    const double allowed = law.friction * pair.size * (1.0 - taken / push);
    Vector3 rub = Vector3::zero();
    if (!law.bonded && rubbed > allowed)
      rub = -(1.0 - allowed / rubbed) * in_space<D>(pair.on_first - pair.push);
    pair.left = 1.0 - taken / push;
    for (int a = 0; a < D; ++a) pair.on_first[a] += taking[a] + rub[a];
    if (is_wall(pair.b)) add_by_wall(surfaces, pair, taking + rub, place);
    add_at(surfaces.on_bodies, pair.a, taking, rub, place);
    if (!is_wall(pair.b)) add_at(surfaces.on_bodies, pair.b, -1.0 * taking, -1.0 * rub, place);
  }
}

template void add_restitution<2>(Domain<2>&);
template void add_restitution<3>(Domain<3>&);

}  // namespace mpm
