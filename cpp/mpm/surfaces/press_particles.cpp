#include <algorithm>
#include <cmath>

#include "mpm/surfaces/across_walls.hpp"
#include "mpm/surfaces/felt_motion.hpp"
#include "mpm/surfaces/kept_of_particle.hpp"
#include "mpm/surfaces/law.hpp"
#include "mpm/surfaces/pressing.hpp"

namespace mpm {
namespace {

template <int D>
Vec<double, D> velocity_of_particle(const ParticlePool<D>& pool, std::uint32_t row) {
  Vec<double, D> v;
  for (int a = 0; a < D; ++a) v[a] = pool.v(a)[row];
  return v;
}

/// How fast waves go in the slower of two bodies [m/s].
template <int D>
double slower_waves(const Body<D>& a, const Body<D>& b) {
  return std::sqrt(std::min(a.stiffness / a.initial_density, b.stiffness / b.initial_density));
}

/// The velocity of a particle against the surface that it touches.
template <int D>
Vec<double, D> slip_velocity(const Domain<D>& domain, const ParticlePool<D>& pool,
                             const PressingTouch<D>& touch, const PressingPatch<D>& of) {
  return velocity_of_particle(pool, touch.row) -
         velocity_of_felt<D>(domain, felt_by(touch, of.felt),
                             pool.position_of(touch.row) + touch.arm);
}

/// What a particle remembers of the body that it presses most, or that it overlapped at the start.
template <int D>
struct MemoryOfParticle {
  int opposite = -1;
  double stiffness = 0.0, set_back = 0.0;  // [N/m; m]
  MemoryOfTouch<D> touch;
};

/// rho c^2 by which a particle is pressed that comes at that speed [Pa]: that of the start, more
/// where its pressure is high or it is as fast as its waves, as behind a shock, and no more than
/// its density bears in the step.
template <int D>
double stiffness_of_matter(const Domain<D>& domain, const Body<D>& body,
                           const ParticlePool<D>& pool, std::uint32_t row, double approach) {
  constexpr double per_pressure = 3.0;  // so that its own half yields by H / 3 at most, (S1)
  double pressure = 0.0;
  for (int k = 0; k < 3; ++k) pressure -= double{pool.stress(k)[row]} / 3.0;
  const double shock = std::sqrt(body.stiffness / body.initial_density) + approach,
               now = std::max(body.initial_density * shock * shock, per_pressure * pressure),
               speed = most_cfl_of_springs * domain.grid.cell_size / domain.time_step;
  return std::min(now, pool.mass()[row] / pool.volume()[row] * speed * speed);
}

/// By how much it is set back that has slid by so much more [m]: what overlapped at the start
/// parts, or flows on.
double set_back_now(double before, double overlap, double slid) {
  return std::clamp(before - 2.0 * slid, 0.0, std::max(overlap + before, 0.0));
}

/// The spring of a touch; returns the way over which it begins.
template <int D>
double push(const Domain<D>& domain, const Body<D>& body, const ParticlePool<D>& pool,
            const Vec<double, D>& u, const MemoryOfParticle<D>& before, PressingTouch<D>& touch) {
  const double h = domain.grid.cell_size, approach = std::max(-dot(touch.slope, u), 0.0);
  const bool was_pressed = touch.opposite == before.opposite && before.stiffness > 0.0;
  touch.push = touch.rub = Vec<double, D>::zero();
  touch.stiffness = touch.pressed_in = touch.rub_work = 0.0;
  double onset = before.touch.onset;
  if (!was_pressed) {
    const double begun = 2.0 * (approach * domain.time_step - touch.overlap),
                 waves = slower_waves(body, domain.body_at(touch.opposite));
    onset = std::clamp(begun, 0.0,
                       std::min(h * approach / waves, most_onset(h, domain.surfaces.spacing)));
  }
  if (!(touch.overlap > -0.5 * onset)) return 0.0;
  // As stiff as it has been: it must give back what it has taken.
  touch.stiffness = std::max(
      2.0 * stiffness_of_point(touch.area, h,
                               1.0 / stiffness_of_matter(domain, body, pool, touch.row, approach),
                               1.0 / domain.body_at(touch.opposite).stiffness),
      was_pressed ? before.stiffness : 0.0);
  touch.pressed_in = pressed_in_by(touch.overlap, onset);
  touch.push = touch.stiffness * touch.pressed_in * touch.slope;
  return onset;
}

/// Friction of the touch that is remembered, with the spring's slip so far.
template <int D>
void rub(const Domain<D>& domain, const Body<D>& body, const Vec<double, D>& u,
         PressingTouch<D>& touch, Vec<double, D>& slip, PressingPatch<D>& of) {
  const double size = norm(touch.push), mu = law_of(domain.contact_settings, body.group,
                                                    domain.body_at(touch.opposite).group)
                                                 .friction;
  if (!(mu > 0.0 && size > 0.0)) {
    slip = Vec<double, D>::zero();
    return;
  }
  const Friction<D> friction =
      mpm::rub(slip, (1.0 / size) * touch.push, domain.time_step * u, touch.stiffness, mu, size);
  touch.rub = friction.force;
  touch.rub_work = friction.taken;
  of.stored_rub += friction.stored;
  slip = friction.slip;
}

/// The touches of one particle, which follow one another. One is remembered and has friction: that
/// of the body that it overlapped at the start, else the one that is pressed most.
template <int D>
void press_particle(const Domain<D>& domain, ParticlePool<D>& pool, int number,
                    std::span<PressingTouch<D>> touches, PressingPatch<D>& of) {
  const PressingColumns& at = pool.pressing;
  const Body<D>& body = domain.body_at(number);
  const KeptOfParticle<D> kept(pool, touches.front().row);
  const MemoryOfParticle<D> before{static_cast<int>(kept.number(at.opposite)) - 1,
                                   kept.number(at.stiffness),
                                   kept.number(at.set_back),
                                   {kept.vector(at.slip), kept.number(at.onset)}};
  MemoryOfParticle<D> now;
  PressingTouch<D>* main = nullptr;
  Vec<double, D> force = Vec<double, D>::zero(), slips_with = force;
  double most = 0.0;
  for (PressingTouch<D>& touch : touches) {
    const Vec<double, D> u = slip_velocity(domain, pool, touch, of);
    const double onset = push(domain, body, pool, u, before, touch);
    if (touch.pressed_in > 0.0) of.stored_push += touch.stiffness * stored_by(touch.overlap, onset);
    force += touch.push;
    double set_back = 0.0;
    if (touch.opposite == before.opposite && before.set_back > 0.0) {
      const Vec<double, D> normal = normalised(touch.slope);
      set_back = set_back_now(before.set_back, touch.overlap,
                              domain.time_step * norm(u - dot(u, normal) * normal));
    }
    const bool remembered = now.set_back > 0.0;
    if (set_back > 0.0 || (!remembered && norm(touch.push) > most)) {
      main = &touch;
      most = norm(touch.push);
      slips_with = u;
      now.opposite = touch.opposite;
      now.set_back = set_back;
      now.touch.onset = onset;
      now.stiffness = touch.pressed_in > 0.0 ? touch.stiffness : 0.0;
    }
  }
  if (main != nullptr) {
    if (main->opposite == before.opposite) now.touch.slip = before.touch.slip;
    rub(domain, body, slips_with, *main, now.touch.slip, of);
  }
  const bool presses = dot(force, force) > 0.0;
  for (const PressingTouch<D>& touch : touches)
    for (const FeltPoint<D>& felt : felt_by(touch, of.felt))
      if (felt.mirrors != 0 && presses)
        add_across_walls(domain, pool.position_of(touch.row), touch, felt, of);
  kept.set(at.force, force);
  kept.set(at.arm, main != nullptr ? main->arm : Vec<double, D>::zero());
  kept.set(at.slip, now.touch.slip);
  kept.number(at.onset) = now.touch.onset;
  kept.number(at.stiffness) = now.stiffness;
  kept.number(at.opposite) = -(now.opposite + 1.0);  // marked
  kept.number(at.set_back) = now.set_back;
}

/// Marked are those that touch something in this step; others have parted.
template <int D>
void clear_parted(ParticlePool<D>& pool, const Patch<D>& patch) {
  const PressingColumns& at = pool.pressing;
  double* const opposite = pool.columns.component(at.opposite);
  for (const std::uint32_t row : pool.rows(patch)) {
    if (opposite[row] < 0.0)
      opposite[row] = -opposite[row];
    else if (opposite[row] > 0.0)
      for (int k = at.force; k <= at.set_back; ++k) pool.columns.component(k)[row] = 0.0;
  }
}

template <int D>
void press_patch(Domain<D>& domain, PressingPatch<D>& of) {
  const Patch<D>& patch = domain.grid.patches[of.patch];
  ParticlePool<D>& pool = domain.pool_of(patch);
  of.stored_push = of.stored_rub = 0.0;
  of.by_walls = {};
  of.moment_by_walls = Vector3::zero();
  of.at_walls = false;
  for (auto first = of.touches.begin(); first != of.touches.end();) {
    const auto last = std::find_if(first, of.touches.end(), [&](const PressingTouch<D>& one) {
      return one.row != first->row;
    });
    press_particle<D>(domain, pool, patch.body, {first, last}, of);
    first = last;
  }
  clear_parted(pool, patch);
}

}  // namespace

template <int D>
void press_particles(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  domain.threads.for_each(surfaces.pressing.size(),
                          [&](std::size_t k) { press_patch(domain, surfaces.pressing[k]); });
  PressedWalls<D>& walls = surfaces.pressed_walls;
  walls = {};
  for (const PressingPatch<D>& of : surfaces.pressing) {
    if (!of.at_walls) continue;
    walls.faces.add(of.by_walls, 1.0);
    walls.moment += of.moment_by_walls;
    walls.any = true;
  }
}

template void press_particles<2>(Domain<2>&);
template void press_particles<3>(Domain<3>&);

}  // namespace mpm
