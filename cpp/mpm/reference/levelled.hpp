#pragma once
// Points that are drawn touching where a face sinks beside an edge, in the reference step.
#include <algorithm>
#include <cmath>
#include <set>

#include "mpm/reference/surface_points.hpp"
#include "mpm/reference/surface_touch.hpp"

namespace mpm::reference {

/// By how much deeper such a point counts, now and first, and how it has slid [m].
template <int D>
struct SurfaceLevelled {
  double by = 0.0, first = 0.0;
  Vec<double, D> slid = Vec<double, D>::zero();

  void slide(const Vec<double, D>& way) {
    slid += way;
    by = std::min(by, std::max(first - 2.0 * norm(slid), 0.0));
  }
};

/// b of (S3).
template <class Surfaces, int D>
double set_back_of(const Surfaces& surfaces, const SurfaceTouch<D>& t) {
  const typename Surfaces::Of of{t.body, t.point, t.whom};
  const auto b = surfaces.set_back.find(of);
  const auto level = surfaces.levelled.find(of);
  return (b != surfaces.set_back.end() ? b->second : 0.0) -
         (level != surfaces.levelled.end() ? level->second.by : 0.0);
}

/// By how much more the sum says that a point is high than it is over the plane of a point that it
/// lies over, at the height of e or, nearly, above; or 0.
template <class Surfaces, int D>
double sunk_where_drawn(const Surfaces& surfaces, const SurfaceTouch<D>& t) {
  const double e = surfaces.e;
  if (is_wall(t.whom) || t.whom == static_cast<Whom>(t.body)) return 0.0;
  if (!(t.z > e && t.z < 1.3 * e)) return 0.0;
  const Vec<double, D>& x = surfaces.bodies[t.body].points[t.point].x;
  double most = 0.0;
  for (const ContactPoint<D>& q : surfaces.other(t).points) {
    const double height = dot(x - q.x, q.N);
    if (q.A_felt > 0.0 && std::abs(height - e) < 0.02 * e &&
        norm(along(x - q.x, q.N)) < (D == 2 ? 0.3 : 0.75) * e)
      most = std::max(most, t.z - std::max(e, height) - 1e-9 * e);
  }
  return most;
}

/// Who is e / 20 away, or has slid too far, is so no more.
template <class Surfaces>
void keep_levelled(Surfaces& surfaces) {
  std::set<typename Surfaces::Of> left;
  surfaces.for_each_touch([&](const auto& t) {
    const typename Surfaces::Of of{t.body, t.point, t.whom};
    const auto level = surfaces.levelled.find(of);
    if (level == surfaces.levelled.end() || !(level->second.by > 0.0)) return;
    if (t.z - surfaces.e - level->second.by < 0.05 * surfaces.e) left.insert(of);
  });
  std::erase_if(surfaces.levelled, [&](const auto& one) { return !left.contains(one.first); });
}

}  // namespace mpm::reference
