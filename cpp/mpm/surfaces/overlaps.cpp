#include "mpm/surfaces/overlaps.hpp"

#include <algorithm>
#include <span>

#include "mpm/fields/lanes.hpp"
#include "mpm/surfaces/felt.hpp"
#include "mpm/surfaces/law.hpp"
#include "mpm/surfaces/levelled.hpp"
#include "mpm/surfaces/mirrored.hpp"
#include "mpm/surfaces/renew_points.hpp"

namespace mpm {
namespace {

/// The faces of the box that push a point of a body back which overlaps them by more than that,
/// o = e / 2 - z: f(opposite, o, normal).
template <int D, class F>
void for_each_wall(const Domain<D>& domain, int body, const Vec<double, D>& place, double least,
                   F&& f) {
  const TileGrid<D>& grid = domain.grid;
  const Walls<D>& walls = grid.walls_of(body);
  if (!walls.touch()) return;
  for (int axis = D - 1; axis >= 0; --axis)  // by the number of the opposite
    for (const int side : {1, 0}) {
      if (walls.face[axis][side] != Wall::contact) continue;
      const double x = place[axis] - grid.origin[axis];
      const double length = grid.cell_size * walls.cells[static_cast<std::size_t>(axis)];
      const double height = side == 0 ? x : length - x;
      const double overlap = 0.5 * domain.surfaces.spacing - height;
      if (!(overlap > least)) continue;
      Vec<double, D> normal = Vec<double, D>::zero();
      normal[axis] = side == 0 ? 1.0 : -1.0;
      f(opposite_wall(axis, side), overlap, normal);
    }
}

/// A point that overlaps a face.
template <int D>
SurfaceTouch<D> touch_of_face(const Domain<D>& domain, int body, std::uint32_t point, Opposite face,
                              double overlap, double set_back, const Vec<double, D>& normal) {
  const Surfaces<D>& surfaces = domain.surfaces;
  SurfaceTouch<D> touch;
  touch.point = point;
  touch.opposite = face;
  touch.overlap = overlap - set_back;
  touch.stiffness = stiffness_at_wall(surfaces.points[point].area, domain.grid.cell_size,
                                      1.0 / domain.body_at(body).stiffness);
  touch.slope = normal;
  const bool debris = surfaces.points[point].face == no_face;
  touch.arm = (debris ? 0.0 : overlap - 0.5 * surfaces.spacing) * normal;  // -z n
  return touch;
}

/// e^(D - 1).
template <int D>
double face_of_spacing(const Surfaces<D>& surfaces) {
  return D == 2 ? surfaces.spacing : surfaces.spacing * surfaces.spacing;
}

/// How far off a point may be felt [m].
template <int D>
double felt_within(const Surfaces<D>& surfaces) {
  return SurfacePoint<D>::reach * surfaces.spacing;
}

/// The sum of the weights of the points of another body around a place over e^(D - 1), (S3).
template <int D>
double sum_of_weights(const Surfaces<D>& surfaces, const SurfacePart<D>& part,
                      const NearPoints& near, const Vec<double, D>& here) {
  constexpr int W = contact_lanes;
  const Batch<W> per_face(1.0 / face_of_spacing(surfaces));
  Batch<W> sums(0.0);
  for_each_lanes<W>(part.awake.data() + near.first, near.count, [&](const auto& rows) {
    Batch<W> square(0.0), area(0.0);
    for (int k = 0; k < W; ++k) area.v[k] = surfaces.points[rows[k]].felt_area;
    for (int a = 0; a < D; ++a) {
      Batch<W> way(0.0);
      for (int k = 0; k < W; ++k) way.v[k] = surfaces.places[rows[k]][a];
      way -= Batch<W>(here[a]);
      square = fma(way, way, square);
    }
    const Batch<W> weight = SurfacePoint<D>::weight(square, surfaces.spacing);
    sums += of_valid(rows, in_steps(area * per_face * weight));
  });
  return sum(sums);
}
/// The same of a point, with the mirrored bodies behind walls.
template <int D>
double sum_of_weights(const Domain<D>& domain, const SurfacePart<D>& part, const NearPoints& near) {
  const Surfaces<D>& surfaces = domain.surfaces;
  double sum = 0.0;
  for_each_image(domain.grid, near.body, surfaces.places[near.point], felt_within(surfaces),
                 [&](const PlaceOrImage<D>& here) {
                   sum += sum_of_weights(surfaces, part, near, here.place);
                 });
  return sum;
}

/// What a point feels of one body: lists of its faces, from SurfacePart::awake_of, with the sums of
/// their weights, and both together.
struct FacesNear {
  std::span<const NearPoints> faces;
  std::span<const double> sums;
  double sum = 0.0;
};

/// A point that overlaps another body by e - e zeta - b, with the points of this that it feels.
template <int D>
void add_touch_of_body(const Domain<D>& domain, SurfacePart<D>& part, const FacesNear& all,
                       double set_back, double least) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const NearPoints& near = all.faces.front();
  const double e = surfaces.spacing, sum = all.sum, share = 1.0 / (sum * face_of_spacing(surfaces));
  const SurfacePoint<D> in(sum);
  SurfaceTouch<D> touch;
  touch.point = near.point;
  touch.opposite = near.body;
  touch.overlap = e - e * in.zeta - set_back;
  if (!(touch.overlap > least)) return;
  touch.stiffness = stiffness_of_point(surfaces.points[near.point].area, domain.grid.cell_size,
                                       1.0 / domain.body_at(part.body).stiffness,
                                       1.0 / domain.body_at(near.body).stiffness);
  touch.first_felt = static_cast<std::uint32_t>(part.felt.size());
  Vec<double, D> slopes = Vec<double, D>::zero();
  for_each_image(domain.grid, near.body, surfaces.places[near.point], felt_within(surfaces),
                 [&](const PlaceOrImage<D>& here) {
                   for (std::size_t f = 0; f < all.faces.size(); ++f) {
                     const double by_face = share_of_face(all.sums[f], sum);
                     if (!(by_face > 0.0)) continue;
                     const NearPoints& of = all.faces[f];
                     for (std::uint32_t k = of.first; k < of.first + of.count; ++k) {
                       const std::uint32_t q = part.awake[k];
                       const Vec<double, D> way = surfaces.places[q] - here.place;
                       const double square = dot(way, way),
                                    weight = SurfacePoint<D>::weight(square, e);
                       if (!(weight > 0.0)) continue;
                       const double area = by_face * surfaces.points[q].felt_area;
                       // do/dx_q = - e dzeta/dS dS/dS_f a_q dw/dx_q
                       const double slope =
                           -e * in.by_sum * area * share * sum * SurfacePoint<D>::slope(square, e);
                       part.felt.push_back({q, area * weight * share, slope * way, here.mirrors});
                     }
                   }
                 });
  // By mirrors and number: lists differ with the time they were made, and sums must not.
  const auto felt = std::span(part.felt).subspan(touch.first_felt);
  std::ranges::sort(felt, [](const FeltPoint<D>& x, const FeltPoint<D>& y) {
    return x.mirrors != y.mirrors ? x.mirrors < y.mirrors : x.point < y.point;
  });
  for (const FeltPoint<D>& one : felt) slopes += mirrored(one.mirrors, one.slope);
  touch.felt_count = static_cast<std::uint32_t>(part.felt.size()) - touch.first_felt;
  touch.slope = slopes;
  touch.arm = (-0.5 * e * in.zeta) * normalised(slopes);
  part.touches.push_back(touch);
}

/// f(FacesNear) for the bodies that a point overlaps, from the first of SurfacePart::awake_of that
/// are not before it on; `least`: of the sum.
template <int D, class F>
void for_each_body(const Domain<D>& domain, const SurfacePart<D>& part, std::uint32_t point,
                   double least, std::size_t& next, std::vector<double>& sums, F&& f) {
  const std::span<const NearPoints> all(part.awake_of);
  while (next < all.size() && all[next].point == point) {
    const std::size_t first = next;
    sums.clear();
    for (; next < all.size() && all[next].point == point && all[next].body == all[first].body;
         ++next) {
      const bool sleeps = domain.surfaces.moved < all[next].sleeps_until;
      sums.push_back(sleeps ? 0.0 : sum_of_weights(domain, part, all[next]));
    }
    const double sum = sum_of_faces(sums);
    if (sum > least) f(FacesNear{all.subspan(first, next - first), sums, sum});
  }
}

/// The sum of weights at an overlap.
template <int D>
double sum_at_overlap(const Domain<D>& domain, double overlap) {
  return SurfacePoint<D>::sum_at(1.0 - overlap / domain.surfaces.spacing);
}

}  // namespace

template <int D>
void find_overlaps(const Domain<D>& domain, SurfacePart<D>& part) {
  const Surfaces<D>& surfaces = domain.surfaces;
  part.touches.clear();
  part.felt.clear();
  nothing_levelled_seen(part);
  // Springs begin from there on, (S4).
  const double e = surfaces.spacing, least = -0.5 * surfaces.longest_onset,
               least_sum = sum_at_overlap(domain, least_overlap_seen(surfaces, part, least));
  std::size_t next = 0;
  for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
    // Bodies that do not deform are held by faces as a whole.
    if (!part.as_one && surfaces.points[c].area > 0.0)
      for_each_wall(domain, part.body, surfaces.places[c], least,
                    [&](Opposite face, double overlap, const Vec<double, D>& normal) {
                      const double back = set_back_of(surfaces, c, face);
                      if (overlap - back > least)
                        part.touches.push_back(
                            touch_of_face(domain, part.body, c, face, overlap, back, normal));
                    });
    for_each_body(domain, part, c, least_sum, next, part.face_sums, [&](const FacesNear& all) {
      const Opposite body = all.faces.front().body;
      double back = set_back_of(surfaces, c, body);
      if (Levelled<D>* const levelled = find_kept(part.levelled, c, body))
        back -= level_unless_open(*levelled, e - e * SurfacePoint<D>(all.sum).zeta, e);
      add_touch_of_body(domain, part, all, back, least);
    });
  }
  keep_levelled(part, e);
}

template <int D>
void for_each_near_surface(const Domain<D>& domain, const SurfacePart<D>& part,
                           const std::function<void(const NearPoints&, double)>& f) {
  std::size_t next = 0;
  std::vector<double> sums;
  for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c)
    for_each_body(domain, part, c, 0.0, next, sums, [&](const FacesNear& all) {
      NearPoints of_body = all.faces.front();  // one list follows the other
      of_body.count = all.faces.back().first + all.faces.back().count - of_body.first;
      f(of_body, SurfacePoint<D>(all.sum).zeta);
    });
}

template <int D>
void set_back_overlaps(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  SetBack& told = domain.contact.set_back;
  const double least_sum = sum_at_overlap(domain, 0.0);
  const double seen = 1e-6 * domain.grid.cell_size;  // of what is drawn into each other
  for (SurfacePart<D>& part : surfaces.parts) {
    if (part.foreign) continue;
    std::size_t next = 0;
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
      const auto set_back = [&](Opposite opposite, double overlap) {
        if (!(overlap > 0.0)) return;  // by rounding
        surfaces.set_back.push_back({c, opposite, overlap});
        told.most = std::max(told.most, overlap);
        if (overlap > seen) ++told.particles;
      };
      if (!part.as_one && surfaces.points[c].area > 0.0)
        for_each_wall(domain, part.body, surfaces.places[c], 0.0,
                      [&](Opposite face, double overlap, const auto&) { set_back(face, overlap); });
      for_each_body(domain, part, c, least_sum, next, part.face_sums, [&](const FacesNear& all) {
        set_back(all.faces.front().body, surfaces.spacing * (1.0 - SurfacePoint<D>(all.sum).zeta));
      });
    }
  }
}

template <int D>
void set_back_more(Domain<D>& domain, const std::vector<KeptOfContact<double>>& before) {
  Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing, least_sum = sum_at_overlap(domain, 0.0), seen = 1e-6 * e;
  std::vector<KeptOfContact<double>> more;
  for (SurfacePart<D>& part : surfaces.parts) {
    if (part.foreign) continue;
    std::size_t next = 0;
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
      const auto look = [&](Opposite opposite, double overlap) {
        const double* const was = find_kept(before, first_number(surfaces, c), opposite);
        overlap -= set_back_of(surfaces, c, opposite) + std::max(was ? *was : 0.0, 0.0);
        if (overlap > seen) more.push_back({c, opposite, overlap});
      };
      if (!part.as_one && surfaces.points[c].area > 0.0)
        for_each_wall(domain, part.body, surfaces.places[c], 0.0,
                      [&](Opposite face, double overlap, const auto&) { look(face, overlap); });
      for_each_body(domain, part, c, least_sum, next, part.face_sums, [&](const FacesNear& all) {
        const Opposite body = all.faces.front().body;
        const Levelled<D>* const levelled = find_kept(part.levelled, c, body);
        look(body, e * (1.0 - SurfacePoint<D>(all.sum).zeta) + (levelled ? levelled->by : 0.0));
      });
    }
  }
  std::erase_if(more, [&](const KeptOfContact<double>& one) {
    double* const known = find_kept(surfaces.set_back, one.point, one.opposite);
    if (known) *known += one.value;
    return known != nullptr;
  });
  surfaces.set_back.insert(surfaces.set_back.end(), more.begin(), more.end());
  std::sort(surfaces.set_back.begin(), surfaces.set_back.end());
}

template void find_overlaps<2>(const Domain<2>&, SurfacePart<2>&);
template void find_overlaps<3>(const Domain<3>&, SurfacePart<3>&);
template void for_each_near_surface<2>(const Domain<2>&, const SurfacePart<2>&,
                                       const std::function<void(const NearPoints&, double)>&);
template void for_each_near_surface<3>(const Domain<3>&, const SurfacePart<3>&,
                                       const std::function<void(const NearPoints&, double)>&);
template void set_back_overlaps<2>(Domain<2>&);
template void set_back_overlaps<3>(Domain<3>&);
template void set_back_more<2>(Domain<2>&, const std::vector<KeptOfContact<double>>&);
template void set_back_more<3>(Domain<3>&, const std::vector<KeptOfContact<double>>&);

}  // namespace mpm
