#include <algorithm>
#include <cmath>
#include <tuple>

#include "mpm/surfaces/felt.hpp"
#include "mpm/surfaces/kept_of_particle.hpp"
#include "mpm/surfaces/law.hpp"
#include "mpm/surfaces/mirrored.hpp"
#include "mpm/surfaces/points_near_patch.hpp"
#include "mpm/surfaces/pressing.hpp"

namespace mpm {
namespace {

/// The edge of a cube of a particle's volume at the start [m].
template <int D>
double edge_of(const Body<D>& body, const ParticlePool<D>& pool, std::uint32_t row) {
  const double volume = pool.mass()[row] / body.initial_density;
  return D == 2 ? std::sqrt(volume) : std::cbrt(volume);
}

/// A particle, and how deep it may lie in bodies around it.
template <int D>
struct ParticleNear {
  const Body<D>& body;
  const ParticlePool<D>& pool;
  std::uint32_t row;
  Vec<double, D> place;
  double edge, radius;  // [m]
  double least;         // the overlap from which on it is looked at [m]
};

/// The sum (S3) of the points of one face around a particle and its images, over e^(D - 1).
template <int D>
double sum_of_face(const Domain<D>& domain, const ParticleNear<D>& of,
                   std::span<const PointInTile<D>> face) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing, per_face = 1.0 / (D == 2 ? e : e * e);
  double sum = 0.0;
  for_each_image(domain.grid, face.front().body, of.place, pressed_within(surfaces),
                 [&](const PlaceOrImage<D>& here) {
                   for (const PointInTile<D>& one : face) {
                     const Vec<double, D> way = surfaces.places[one.point] - here.place;
                     const double weight = SurfacePoint<D>::weight(dot(way, way), e);
                     sum += in_steps(surfaces.points[one.point].felt_area * per_face * weight);
                   }
                 });
  return sum;
}

/// The points of a face that a particle feels, by its share of the sum.
template <int D>
void add_felt(const Domain<D>& domain, const ParticleNear<D>& of,
              std::span<const PointInTile<D>> face, double by_face, double sum, double by_sum,
              std::vector<FeltPoint<D>>& felt) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing, share = 1.0 / (sum * (D == 2 ? e : e * e));
  for_each_image(
      domain.grid, face.front().body, of.place, pressed_within(surfaces),
      [&](const PlaceOrImage<D>& here) {
        for (const PointInTile<D>& one : face) {
          const Vec<double, D> way = surfaces.places[one.point] - here.place;
          const double square = dot(way, way), weight = SurfacePoint<D>::weight(square, e);
          if (!(weight > 0.0)) continue;
          const double area = by_face * surfaces.points[one.point].felt_area;
          const double slope = -e * by_sum * area * share * sum * SurfacePoint<D>::slope(square, e);
          felt.push_back({one.point, area * weight * share, slope * way, here.mirrors});
        }
      });
}

/// The touch of a particle and a body, of which it may feel these points, by faces.
template <int D>
void add_touch(const Domain<D>& domain, const ParticleNear<D>& of,
               std::span<const PointInTile<D>> points, PressingPatch<D>& to) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing;
  thread_local std::vector<std::span<const PointInTile<D>>> faces;
  thread_local std::vector<double> sums;
  faces.clear();
  sums.clear();
  for (auto first = points.begin(); first != points.end();) {
    const auto last = std::find_if(
        first, points.end(), [&](const PointInTile<D>& one) { return one.face != first->face; });
    faces.emplace_back(first, last);
    sums.push_back(sum_of_face<D>(domain, of, faces.back()));
    first = last;
  }
  const double sum = sum_of_faces(sums);
  if (!(sum > 0.0)) return;
  const SurfacePoint<D> in(sum);
  const int opposite = points.front().body;
  const PressingColumns& at = of.pool.pressing;
  const auto kept = [&](int column) { return of.pool.columns.component(column)[of.row]; };
  const double back = kept(at.opposite) == opposite + 1.0 ? kept(at.set_back) : 0.0;
  PressingTouch<D> touch;
  touch.row = of.row;
  touch.opposite = opposite;
  touch.overlap = 0.5 * e + of.radius - e * in.zeta - back;
  if (!(touch.overlap > of.least)) return;
  touch.sunk = e - e * in.zeta - back;
  touch.area = D == 2 ? of.edge : of.edge * of.edge;
  touch.first_felt = static_cast<std::uint32_t>(to.felt.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double by_face = share_of_face(sums[f], sum);
    if (by_face > 0.0) add_felt<D>(domain, of, faces[f], by_face, sum, in.by_sum, to.felt);
  }
  const auto felt = std::span(to.felt).subspan(touch.first_felt);
  std::ranges::sort(felt, {},
                    [](const FeltPoint<D>& one) { return std::tuple(one.mirrors, one.point); });
  touch.slope = Vec<double, D>::zero();
  for (const FeltPoint<D>& one : felt) touch.slope += mirrored(one.mirrors, one.slope);
  touch.felt_count = static_cast<std::uint32_t>(felt.size());
  // In the middle of the overlap of both.
  touch.arm = -0.5 * (of.radius + e * in.zeta - 0.5 * e) * normalised(touch.slope);
  to.touches.push_back(touch);
}

/// What the particles of a patch touch.
template <int D>
void find_in_patch(const Domain<D>& domain, PressingPatch<D>& to) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const Patch<D>& patch = domain.grid.patches[to.patch];
  const Body<D>& body = domain.body_of(patch);
  const ParticlePool<D>& pool = domain.pool_of(body);
  to.touches.clear();
  to.felt.clear();
  thread_local PointsNear<D> near;
  if (!near.find(domain, patch)) return;
  const double least = -0.5 * most_onset(domain.grid.cell_size, surfaces.spacing);
  const double* const failed =
      pool.at.failed >= 0 ? pool.columns.component(pool.at.failed) : nullptr;
  patch.for_each_cell([&](int cell, std::uint32_t begin, std::uint32_t end) {
    const std::span<const PointInTile<D>> points = near.of(cell);
    if (points.empty()) return;
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t row = pool.order[k];
      // It takes no part in the next step, where it would be pushed.
      if (failed != nullptr && failed[row] >= static_cast<double>(FailureAction::erode)) continue;
      const double edge = edge_of(body, pool, row);
      const ParticleNear<D> of{
          body, pool, row, pool.position_of(row), edge, std::min(0.5 * edge, surfaces.spacing),
          least};
      for (auto first = points.begin(); first != points.end();) {
        const auto last = std::find_if(first, points.end(), [&](const PointInTile<D>& one) {
          return one.body != first->body;
        });
        add_touch<D>(domain, of, {first, last}, to);
        first = last;
      }
    }
  });
}

/// The place of a patch's sums among those of all: behind those of parts, by its tile.
template <int D>
std::uint64_t order_of(const Index<D>& tile) {
  std::uint64_t order = 1;
  for (int a = D - 1; a >= 0; --a)
    order =
        order << 21 | (static_cast<std::uint64_t>(tile[static_cast<std::size_t>(a)] + (1 << 20)) &
                       ((1u << 21) - 1));
  return order;
}

/// How deep a particle overlapped the same body in the step before; 0 if it did not [m].
template <int D>
double overlap_before(const std::vector<PressingPatch<D>>& before, std::size_t k,
                      const PressingTouch<D>& touch) {
  if (k >= before.size()) return 0.0;
  for (const PressingTouch<D>& one : before[k].touches)
    if (one.row == touch.row && one.opposite == touch.opposite) return std::max(one.overlap, 0.0);
  return 0.0;
}

}  // namespace

template <int D>
void list_points_by_tile(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  surfaces.by_tile.clear();
  for (const SurfacePart<D>& part : surfaces.parts)
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
      const ContactPoint<D>& point = surfaces.points[c];
      if (!(point.felt_area > 0.0) || point.face == no_face) continue;
      const Index<D> tile = domain.grid.tile_of(domain.grid.cell_of(surfaces.places[c]));
      surfaces.by_tile.push_back({tile, part.body, point.face, c});
    }
  std::ranges::stable_sort(surfaces.by_tile, tile_less<D>, &PointInTile<D>::tile);
}

template <int D>
void find_pressing(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  const std::vector<Patch<D>>& patches = domain.grid.patches;
  std::size_t count = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (patches[p].foreign || domain.body_of(patches[p]).kind != BodyKind::deformable) continue;
    if (count == surfaces.pressing.size()) surfaces.pressing.emplace_back();
    PressingPatch<D>& of = surfaces.pressing[count++];
    of.patch = static_cast<std::uint32_t>(p);
    of.order = order_of<D>(patches[p].tile);
  }
  surfaces.pressing.resize(count);
  domain.threads.for_each(count,
                          [&](std::size_t k) { find_in_patch(domain, surfaces.pressing[k]); });
}

template <int D>
void set_back_pressing(Domain<D>& domain) {
  if (!particles_press(domain)) return;
  // What is pressed already is not set back by that again.
  const std::vector<PressingPatch<D>> before = domain.surfaces.pressing;
  find_pressing(domain);
  const double seen = 1e-6 * domain.grid.cell_size;
  SetBack& told = domain.contact.set_back;
  for (std::size_t k = 0; k < domain.surfaces.pressing.size(); ++k) {
    const PressingPatch<D>& of = domain.surfaces.pressing[k];
    ParticlePool<D>& pool = domain.pool_of(domain.grid.patches[of.patch]);
    for (const PressingTouch<D>& touch : of.touches) {
      const double more = touch.overlap - overlap_before<D>(before, k, touch);
      const KeptOfParticle<D> kept(pool, touch.row);
      double& opposite = kept.number(pool.pressing.opposite);
      double& set_back = kept.number(pool.pressing.set_back);
      const bool is_known = opposite == touch.opposite + 1.0;
      if (!(more > (is_known ? 0.0 : set_back))) continue;
      if (!is_known) kept.forget();
      set_back = is_known ? set_back + more : more;
      opposite = touch.opposite + 1.0;
      if (domain.step > 0) continue;  // what is drawn into each other is told
      told.most = std::max(told.most, more);
      if (more > seen) ++told.particles;
    }
  }
}

template void list_points_by_tile<2>(Domain<2>&);
template void list_points_by_tile<3>(Domain<3>&);
template void find_pressing<2>(Domain<2>&);
template void find_pressing<3>(Domain<3>&);
template void set_back_pressing<2>(Domain<2>&);
template void set_back_pressing<3>(Domain<3>&);

}  // namespace mpm
