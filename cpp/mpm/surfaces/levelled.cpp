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

/// Does a point touch, as drawn, the plane of a point of another body that it lies over?
template <int D>
bool is_drawn_touching(const Surfaces<D>& surfaces, const SurfacePart<D>& part,
                       const NearPoints& near) {
  const double e = surfaces.spacing;
  return std::ranges::any_of(
      std::span(part.awake.data() + near.first, near.count), [&](std::uint32_t q) {
        const Vec<double, D> way = surfaces.places[near.point] - surfaces.places[q];
        const double height = dot(way, surfaces.points[q].normal);
        return std::abs(height - e) < drawn_touching * e &&
               dot(way, way) - height * height < beside<D> * e * beside<D> * e;
      });
}

}  // namespace

template <int D>
void level_faces(Domain<D>& domain) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing;
  for (SurfacePart<D>& part : domain.surfaces.parts) {
    if (part.foreign) continue;
    for_each_near_surface(domain, part, [&](const NearPoints& near, double zeta) {
      const double sunk = e * (zeta - 1.0) - above * e;
      if (near.body == part.body || !(sunk > 0.0 && sunk < most_levelled * e)) return;
      if (is_drawn_touching(surfaces, part, near))
        part.levelled.push_back({near.point, near.body, {sunk, sunk}});
    });
  }
}

template void level_faces<2>(Domain<2>&);
template void level_faces<3>(Domain<3>&);

}  // namespace mpm
