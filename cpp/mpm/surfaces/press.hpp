#pragma once
#include "mpm/domain.hpp"
#include "mpm/math/inverse.hpp"
#include "mpm/surfaces/host_motion.hpp"

namespace mpm {

/// From the host of a point to a place, in the body at the start: d + F^-1 (x - x_c).
template <int D>
Vec<double, D> reach_of(const Domain<D>& domain, std::uint32_t c, const Vec<double, D>& place) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const ContactPoint<D>& point = surfaces.points[c];
  const Host<D>& host = surfaces.hosts[point.host];
  const SurfacePart<D>& part = surfaces.parts[host.part];
  if (part.as_one) return point.offset;  // nobody asks for it
  const Mat<double, D> F = part.foreign
                               ? host_elsewhere(surfaces, point.host).deformation
                               : deformation_of(domain.pool_of(domain.body_at(part.body)), host);
  return point.offset + product(inverse_of(F), place - surfaces.places[c]);
}

/// Does friction act at a touch?
template <int D>
bool rubs(const SurfaceTouch<D>& touch) {
  return dot(touch.rub, touch.rub) > 0.0;
}

/// How all hosts in touch move, for friction.
template <int D>
void find_motions(Domain<D>& domain);

/// Friction of the touches of a part, with its memory; what is stored in their springs, and what
/// faces of the box give. Needs find_overlaps() and find_motions().
template <int D>
void press_part(Domain<D>& domain, SurfacePart<D>& part);

}  // namespace mpm
