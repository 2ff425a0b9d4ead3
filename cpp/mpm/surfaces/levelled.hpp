#pragma once
// Faces that are drawn touching. Beside an edge the surface of a face sinks, as (S3) sums over what
// is left of it there, and what is drawn touching would bear nothing on the last third of a cell.
// Such points count deeper by what the surface sinks below the plane of its points there, so that
// springs begin as elsewhere, until they slide: by twice the slip less. What lies between as drawn,
// as beside the place where a ball touches, stays.
#include <algorithm>
#include <limits>

#include "mpm/domain.hpp"

namespace mpm {

inline constexpr double most_levelled = 0.3;      // spacings: a face sinks by less where it ends
inline constexpr double levelled_gap = 0.05;      // spacings of a gap that ends it
inline constexpr double levelled_per_slip = 2.0;  // faces sink by less than .3 of the way

/// At the start, after what overlaps is set back.
template <int D>
void level_faces(Domain<D>& domain);

/// What lies lower is nothing that find_overlaps() must see.
template <int D>
double least_overlap_seen(const Surfaces<D>& surfaces, const SurfacePart<D>& part, double least) {
  const double e = surfaces.spacing;
  return part.levelled.empty() ? least : std::min(least, -levelled_gap * e) - most_levelled * e;
}

/// By how much deeper a point counts of which the surface lies at an overlap, set back by nothing;
/// nothing from now on if a gap has opened.
template <int D>
double level_unless_open(Levelled<D>& levelled, double overlap, double spacing) {
  levelled.gap = -(overlap + levelled.by);
  if (!(levelled.gap < levelled_gap * spacing)) levelled.by = 0.0;
  return levelled.by;
}

/// `way`: what the surfaces have slipped on each other in the step; its part along the normal is
/// left out.
template <int D>
void go_on(Levelled<D>& levelled, const Vec<double, D>& way, const Vec<double, D>& normal) {
  levelled.slid += way - dot(way, normal) * normal;
  const double left = levelled.first - levelled_per_slip * norm(levelled.slid);
  levelled.by = std::clamp(left, 0.0, levelled.by);
}

/// Before and after overlaps are found: what was not seen lies farther off.
template <int D>
void nothing_levelled_seen(SurfacePart<D>& part) {
  for (auto& one : part.levelled) one.value.gap = std::numeric_limits<double>::infinity();
}
template <int D>
void keep_levelled(SurfacePart<D>& part, double spacing) {
  std::erase_if(part.levelled, [&](const KeptOfContact<Levelled<D>>& one) {
    return !(one.value.by > 0.0 && one.value.gap < levelled_gap * spacing);
  });
}

}  // namespace mpm
