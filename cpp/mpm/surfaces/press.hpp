#pragma once
#include "mpm/domain.hpp"
#include "mpm/surfaces/host_motion.hpp"

namespace mpm {

/// A place in the body of a point at the start: d + F^-1 (x - x_s) from its host, x_s where the
/// point is on the surface.
template <int D>
PlaceAtHost<D> reach_of(const Domain<D>& domain, std::uint32_t c, const Vec<double, D>& place) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const ContactPoint<D>& point = surfaces.points[c];
  if (surfaces.parts[surfaces.hosts[point.host].part].as_one)
    return point.surface;  // not asked for
  const HostDeformation<D> deformation = deformation_at(domain, point.host);
  const Fibre<D> fibre(deformation.F, point.normal, behind_surface(surfaces, point));
  const Vec<double, D> surface = surfaces.places[c] + fibre.behind * fibre.direction;
  return {point.surface.away + product(deformation.inverse, place - surface), point.surface.second};
}

/// Does friction act at a touch?
template <int D>
bool rubs(const SurfaceTouch<D>& touch) {
  return dot(touch.rub, touch.rub) > 0.0;
}

/// How all hosts in touch move, for friction, and are deformed.
template <int D>
void find_motions(Domain<D>& domain);

/// At the start: what approaches something so near that its springs would have begun already is
/// set back by as much, (S4).
template <int D>
void set_back_onsets(Domain<D>& domain);

/// Springs and friction of the touches of a part, with their memory; what is stored in their
/// springs, and what faces of the box give. Needs find_overlaps() and find_motions().
template <int D>
void press_part(Domain<D>& domain, SurfacePart<D>& part);

}  // namespace mpm
