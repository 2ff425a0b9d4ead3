#pragma once
// Particles whose nodes lie in space, of what flows, press the surfaces of bodies on nodes of their
// own, and of bodies that do not deform. A particle p is a ball as wide as a cube of its first
// volume; it overlaps a surface, of which the sum (S3) of felt.hpp tells the height e zeta over its
// points, by
//   o = e / 2 + r - b - e zeta,   r = V0^(1/D) / 2, e at most,                              (S7)
// and is pushed by springs of the energy k o^2 / 2 that begin softly, (S4), with friction that
// remembers, (S2). k is twice that of (S1) with A = V0^((D-1)/D), as no points push back. b is by
// how much it overlapped at the start. A step ends with
//   find_pressing()     particles that overlap, and the points that they feel
//   press_particles()   springs and friction, kept in columns of the particles
//   give_pressing()     the opposites to the points felt
// and in the next load_by_particles() gives the forces to the particles' nodes: of springs at the
// particle, of friction at the surface, as loads are given (decision 0071).
#include "mpm/domain.hpp"
#include "mpm/ledger/work.hpp"
#include "mpm/surfaces/acting.hpp"
#include "mpm/surfaces/mirrored.hpp"

namespace mpm {

/// Are there such particles?
template <int D>
bool particles_press(const Domain<D>& domain) {
  return domain.surfaces.meet && domain.surfaces.pressed_by > 0;
}

/// The points that may be felt, by tiles of space; when lists of points are made.
template <int D>
void list_points_by_tile(Domain<D>& domain);

template <int D>
void find_pressing(Domain<D>& domain);

/// At the start, and where surfaces have been uncovered since the last step: what overlaps is set
/// back by as much more as it does.
template <int D>
void set_back_pressing(Domain<D>& domain);

/// Needs find_pressing() and find_motions().
template <int D>
void press_particles(Domain<D>& domain);

/// f(GivenToPoint) for what the touches of a patch give to the points that they feel.
template <int D, class F>
void for_each_given(const Domain<D>& domain, const PressingPatch<D>& patch, F&& f) {
  const ParticlePool<D>& pool = domain.pool_of(domain.grid.patches[patch.patch]);
  for (const PressingTouch<D>& touch : patch.touches) {
    if (!(touch.pressed_in > 0.0)) continue;
    const Vec<double, D> place = pool.position_of(touch.row) + touch.arm;
    const double push = touch.stiffness * touch.pressed_in;
    const bool rubs = dot(touch.rub, touch.rub) > 0.0;
    for (std::uint32_t k = touch.first_felt; k < touch.first_felt + touch.felt_count; ++k) {
      const FeltPoint<D>& felt = patch.felt[k];
      f(GivenToPoint<D>{patch.order, felt.point, rubs, -push * felt.slope,
                        mirrored(felt.mirrors, -felt.share * touch.rub),
                        mirrored_place(domain.grid, felt.mirrors, place)});
    }
  }
}

/// What particles were pushed with, to the nodes of a patch.
template <int D>
void load_by_particles(Domain<D>& domain, std::size_t patch);

/// The work of these forces on a patch, once its nodes are advanced: of springs, of friction.
struct PressingWork {
  Work push, rub;
};
template <int D>
PressingWork work_of_pressing(Domain<D>& domain, std::size_t patch);

}  // namespace mpm
