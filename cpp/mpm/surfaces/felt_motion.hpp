#pragma once
// How surfaces move that are felt, once find_motions() has found it.
#include <span>

#include "mpm/surfaces/as_one.hpp"
#include "mpm/surfaces/mirrored.hpp"
#include "mpm/surfaces/press.hpp"

namespace mpm {

/// The points that a touch feels, of those of all.
template <class Touch, int D>
std::span<const FeltPoint<D>> felt_by(const Touch& touch, const std::vector<FeltPoint<D>>& all) {
  return {all.data() + touch.first_felt, touch.felt_count};
}

/// How fast the body of a point moves at a place.
template <int D>
Vec<double, D> velocity_of_point(const Domain<D>& domain, std::uint32_t point,
                                 const PlaceAtHost<D>& reach, const Vec<double, D>& place) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const std::uint32_t host = surfaces.points[point].host;
  const SurfacePart<D>& part = surfaces.parts[surfaces.hosts[host].part];
  if (part.foreign && !part.as_one) return host_elsewhere(surfaces, host).motion.at(reach);
  if (!part.as_one) return surfaces.in_touch[surfaces.place_of_motion[host] - 1].motion.at(reach);
  const Vector3 v = motion_as_one(domain, part.body).velocity_at(in_space<D>(place));
  Vec<double, D> velocity;
  for (int a = 0; a < D; ++a) velocity[a] = v[a];
  return velocity;
}

/// The mean velocity of felt points at a place, by their shares.
template <int D>
Vec<double, D> velocity_of_felt(const Domain<D>& domain, std::span<const FeltPoint<D>> all,
                                const Vec<double, D>& place) {
  Vec<double, D> mean = Vec<double, D>::zero();
  for (const FeltPoint<D>& felt : all) {
    const Vec<double, D> there = mirrored_place(domain.grid, felt.mirrors, place);
    mean += felt.share *
            mirrored(felt.mirrors, velocity_of_point(domain, felt.point,
                                                     reach_of(domain, felt.point, there), there));
  }
  return mean;
}

}  // namespace mpm
