#include "mpm/surfaces/levelled.hpp"

#include <algorithm>
#include <span>

#include "mpm/surfaces/overlaps.hpp"

namespace mpm {
namespace {

constexpr double drawn_touching = 0.02;  // spacings: a gap or an overlap that none has meant
constexpr double above = 1e-9;           // spacings: rounding must not choose what pushes at once
// Spacings: as far as a place of a face is from the nearest of its points, e / 2 or e apart.
template <int D>
constexpr double beside = D == 2 ? 0.3 : 0.75;

/// By how much a surface sinks below the plane of one of its points, over which a point of another
/// body lies that touches it as drawn; what lies between as drawn stays. 0 if there is none [m].
template <int D>
double sunk_below_plane(const Surfaces<D>& surfaces, const SurfacePart<D>& part,
                        const NearPoints& near, double zeta) {
  const double e = surfaces.spacing;
  double most = 0.0;
  for (const std::uint32_t q : std::span(part.awake.data() + near.first, near.count)) {
    const Vec<double, D> way = surfaces.places[near.point] - surfaces.places[q];
    const double height = dot(way, surfaces.points[q].normal);
    if (std::abs(height - e) < drawn_touching * e &&
        dot(way, way) - height * height < beside<D> * e * beside<D> * e)
      most = std::max(most, e * zeta - std::max(e, height));
  }
  return most;
}

}  // namespace

template <int D>
void level_faces(Domain<D>& domain) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing;
  for (SurfacePart<D>& part : domain.surfaces.parts) {
    if (part.foreign) continue;
    for_each_near_surface(domain, part, [&](const NearPoints& near, double zeta) {
      if (near.body == part.body || !(zeta > 1.0 && zeta < 1.0 + most_levelled)) return;
      const double sunk = sunk_below_plane(surfaces, part, near, zeta) - above * e;
      if (sunk > 0.0) part.levelled.push_back({near.point, near.body, {sunk, sunk}});
    });
  }
}

template void level_faces<2>(Domain<2>&);
template void level_faces<3>(Domain<3>&);

}  // namespace mpm
