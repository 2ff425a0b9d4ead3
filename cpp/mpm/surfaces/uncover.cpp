#include "mpm/surfaces/uncover.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mpm/comm/all_sums.hpp"
#include "mpm/surfaces/boxes_of_bodies.hpp"
#include "mpm/surfaces/host_motion.hpp"
#include "mpm/surfaces/overlaps.hpp"
#include "mpm/surfaces/pressing.hpp"
#include "mpm/surfaces/renew_points.hpp"

namespace mpm {
namespace {

// How far off neighbours are, in edges of a particle: of lattices those across a corner are none.
constexpr double most_apart = 1.3;
// The faces of what has failed: those of a body that look along one axis and way are one.
constexpr std::int32_t first_face = 1 << 20;

/// A particle that has failed, and where it is in its body.
template <int D>
struct FailedParticle {
  std::int32_t body = 0;
  std::uint32_t particle = 0;
  double edge = 0.0;  // [m]
  Vec<double, D> place;
};

/// A contact point between a particle and one beside it that has failed.
template <int D>
struct UncoveredPoint {
  LaidPoint<D> laid;
  std::uint32_t beside = 0;
  std::int32_t number = 0;  // of those between both

  auto key() const { return std::tuple(laid.given.body, laid.given.particle, beside, number); }
};

/// The edge of a square or cube of the size that a particle has in its body [m].
template <int D>
double edge_in_body(const ParticlePool<D>& pool, std::uint32_t row, const Mat<double, D>& F) {
  return std::pow(pool.volume()[row] / determinant(F), 1.0 / D);
}

template <int D>
Mat<double, D> deformation_at(const ParticlePool<D>& pool, std::uint32_t row) {
  return deformation_of(pool, Host<D>{0, row, 0, {}});
}

/// f(patch, pool, row) for own particles that may fail.
template <int D, class F>
void for_each_that_may_fail(Domain<D>& domain, F&& f) {
  for (const Patch<D>& patch : domain.grid.patches) {
    ParticlePool<D>& pool = domain.pool_of(patch);
    if (!patch.keeps || patch.foreign || pool.opened < 0) continue;
    for (const std::uint32_t row : pool.rows(patch)) f(patch, pool, row);
  }
}

/// Those of all ranks that had not failed when this was last asked.
template <int D>
std::vector<FailedParticle<D>> failed_since(Domain<D>& domain) {
  std::vector<FailedParticle<D>> found;
  for_each_that_may_fail(domain, [&](const Patch<D>& patch, ParticlePool<D>& pool,
                                     std::uint32_t row) {
    double& opened = pool.columns.component(pool.opened)[row];
    if (opened > 0.0 || !(pool.columns.component(pool.at.failed)[row] > 0.0)) return;
    opened = 1.0;
    found.push_back({patch.body, pool.id[row], edge_in_body(pool, row, deformation_at(pool, row)),
                     listed_place(pool, row)});
  });
  entries_of_all(*domain.grid.partition.comm, found);
  return found;
}

/// Directions square to a normal and to each other.
inline std::array<Vec<double, 2>, 1> across(const Vec<double, 2>& N) {
  Vec<double, 2> t;
  t[0] = -N[1];
  t[1] = N[0];
  return {t};
}
inline std::array<Vec<double, 3>, 2> across(const Vec<double, 3>& N) {
  int least = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(N[a]) < std::abs(N[least])) least = a;
  Vec<double, 3> along = Vec<double, 3>::zero();
  along[least] = 1.0;
  const Vec<double, 3> first = normalised(cross(N, along));
  return {first, cross(N, first)};
}

/// The points of a particle on the face to one that has failed.
template <int D>
void add_points(const Domain<D>& domain, const Patch<D>& patch, const ParticlePool<D>& pool,
                std::uint32_t row, const FailedParticle<D>& beside,
                std::vector<UncoveredPoint<D>>& points) {
  const double e = domain.surfaces.spacing;
  const Vec<double, D> X = listed_place(pool, row), way = beside.place - X;
  const Mat<double, D> F = deformation_at(pool, row);
  const double apart = norm(way), edge = edge_in_body(pool, row, F);
  if (!(apart < most_apart * edge)) return;
  const Vec<double, D> N = (1.0 / apart) * way;
  int axis = 0;
  for (int a = 1; a < D; ++a)
    if (std::abs(N[a]) > std::abs(N[axis])) axis = a;
  const int count = std::max(1, static_cast<int>(std::lround(edge / (D == 2 ? 0.5 * e : e))));
  const double area = std::pow(edge / count, D - 1);
  const Fibre<D> fibre(F, N, 0.5 * e);
  for (int number = 0; number < power(count, D - 1); ++number) {
    Vec<double, D> offset = (0.5 * apart) * N;
    int left = number;
    for (const Vec<double, D>& direction : across(N)) {
      offset += ((left % count + 0.5) / count - 0.5) * edge * direction;
      left /= count;
    }
    UncoveredPoint<D>& point = points.emplace_back();
    point.beside = beside.particle;
    point.number = number;
    point.laid.given = {patch.body,
                        pool.id[row],
                        offset,
                        N,
                        area,
                        area,
                        first_face + 2 * axis + (N[axis] < 0.0 ? 1 : 0),
                        0};
    point.laid.place = pool.position_of(row) + product(F, offset) - fibre.behind * fibre.direction;
    point.laid.at_start = X + offset - (0.5 * e) * N;
  }
}

/// How deep points overlap bodies and faces of the box, of all ranks.
template <int D>
std::vector<KeptOfContact<double>> overlaps_by_number(const Domain<D>& domain) {
  std::vector<KeptOfContact<double>> found;
  for (const SurfacePart<D>& part : domain.surfaces.parts)
    for (const SurfaceTouch<D>& touch : part.touches)
      if (!part.foreign)
        found.push_back(
            {first_number(domain.surfaces, touch.point), touch.opposite, touch.overlap});
  entries_of_all(*domain.grid.partition.comm, found);
  std::ranges::sort(found, std::less<>{});
  return found;
}

}  // namespace

template <int D>
void uncover(Domain<D>& domain) {
  const std::vector<FailedParticle<D>> failed = failed_since(domain);
  if (failed.empty() || !domain.surfaces.exist()) return;
  double reach = 0.0;
  for (const FailedParticle<D>& one : failed) reach = std::max(reach, one.edge);
  BoxesOfBodies<D, FailedParticle<D>> boxes(2.0 * most_apart * reach);
  for (const FailedParticle<D>& one : failed) boxes.add(one.body, one.place, one);
  std::vector<UncoveredPoint<D>> points;
  for_each_that_may_fail(domain, [&](const Patch<D>& patch, const ParticlePool<D>& pool,
                                     std::uint32_t row) {
    if (pool.columns.component(pool.opened)[row] > 0.0) return;
    boxes.for_each_near(patch.body, listed_place(pool, row), [&](const FailedParticle<D>& beside) {
      add_points(domain, patch, pool, row, beside, points);
    });
  });
  entries_of_all(*domain.grid.partition.comm, points);
  std::ranges::sort(points, {}, &UncoveredPoint<D>::key);
  std::vector<LaidPoint<D>> more;
  more.reserve(points.size());
  for (const UncoveredPoint<D>& point : points) more.push_back(point.laid);
  const std::vector<KeptOfContact<double>> overlaps = overlaps_by_number(domain);
  RenewedPoints<D> surface(domain, std::vector<bool>(domain.bodies.size(), false));
  surface.uncover(domain, more);
  surface.lay(domain);
  set_back_more(domain, overlaps);
  set_back_pressing(domain);
}

template void uncover<2>(Domain<2>&);
template void uncover<3>(Domain<3>&);

}  // namespace mpm
