#include "mpm/surfaces/renew_points.hpp"

#include <algorithm>
#include <cmath>

#include "mpm/comm/all_sums.hpp"
#include "mpm/surfaces/boxes_of_bodies.hpp"
#include "mpm/surfaces/folds.hpp"
#include "mpm/surfaces/host_motion.hpp"
#include "mpm/surfaces/near_points.hpp"
#include "mpm/surfaces/parts.hpp"

namespace mpm {
namespace {

// Cosine of the angle within which a face looks at another: those of a waist do not.
constexpr double facing = 0.5;

/// How a host has been deformed, and its second derivatives.
template <int D>
struct HostBefore {
  Mat<double, D> F{}, second{};

  HostBefore(Domain<D>& domain, const Host<D>& host)
      : F(deformation_of(domain, host)), second(second_derivatives_of(domain, host)) {}

  Vec<double, D> away(const PlaceAtHost<D>& place) const {
    return product(F, place.away) + product(second, place.second);
  }
  /// Moments about the host, sum t (x) d and sum t (x) b, are sum t (x) d' by now. What the second
  /// order had for the new functions is not known: none in the coming step.
  void change(ForceAtHost<D>& forces) const {
    Mat<double, D> moment{};
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        for (int k = 0; k < D; ++k)
          moment[a][b] += forces.moment[a][k] * F[b][k] + forces.second[a][k] * second[b][k];
    forces.moment = moment;
    forces.second = {};
  }
};

/// What all ranks have, by points; only what points of own parts keep, with their numbers by now.
template <int D, class Value, class Give>
void give_kept(Surfaces<D>& surfaces, const std::vector<std::uint32_t>& point_of,
               const std::vector<KeptOfContact<Value>>& kept, Give&& give) {
  for (KeptOfContact<Value> one : kept) {
    one.point = point_of[one.point];
    if (!part_of_point(surfaces, one.point).foreign) give(one);
  }
}

}  // namespace

template <int D>
std::vector<LaidPoint<D>> laid_points(Domain<D>& domain, const std::vector<bool>& renewed) {
  std::vector<LaidPoint<D>> points;
  const Surfaces<D>& surfaces = domain.surfaces;
  for (const SurfacePart<D>& part : surfaces.parts) {
    if (part.foreign) continue;
    const bool deformed = !part.as_one && renewed[static_cast<std::size_t>(part.body)];
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
      const ContactPoint<D>& point = surfaces.points[c];
      const Host<D>& host = surfaces.hosts[point.host];
      LaidPoint<D>& laid = points.emplace_back();
      laid.given = {part.body,       0,          point.surface.away,       point.normal, point.area,
                    point.felt_area, point.face, first_number(surfaces, c)};
      // Those of a body that does not deform go with all of it.
      if (!part.as_one) {
        const ParticlePool<D>& pool = domain.pool_of(domain.body_at(part.body));
        laid.given.particle = pool.id[host.row];
        laid.failed = pool.opened >= 0 && pool.columns.component(pool.opened)[host.row] > 0.0;
      }
      if (deformed) {
        const HostBefore<D> before(domain, host);
        laid.given.offset = before.away(point.surface);
        laid.given.normal = Fibre<D>(before.F, point.normal, 0.0).direction;
      }
      laid.place = surfaces.places[c];
      laid.at_start = place_in_body(domain, c);
    }
  }
  entries_of_all(*domain.grid.partition.comm, points);
  std::ranges::sort(points, {}, [](const LaidPoint<D>& one) { return one.given.number; });
  return points;
}

template <int D>
RenewedPoints<D>::RenewedPoints(Domain<D>& domain, const std::vector<bool>& renewed) {
  if (!domain.surfaces.exist()) return;
  points_ = laid_points(domain, renewed);
  // From now on their places in the body are these, as those of particles: none are near by a fold
  // (near_themselves).
  for (LaidPoint<D>& point : points_)
    if (renewed[static_cast<std::size_t>(point.given.body)]) point.at_start = point.place;
  keep_memory(domain, renewed);
}

template <int D>
void RenewedPoints<D>::keep_memory(Domain<D>& domain, const std::vector<bool>& renewed) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const auto keep = [&](const auto& from, auto& to) {
    for (auto one : from) {
      one.point = first_number(surfaces, one.point);
      to.push_back(one);
    }
  };
  keep(surfaces.set_back, set_back_);
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    if (part.foreign) continue;
    keep(part.kept, kept_);
    keep(part.levelled, levelled_);
    if (part.at_walls) from_walls_.push_back({k, part.body, part.by_walls, part.moment_by_walls});
  }
  for (ActingOnHost<D> on : surfaces.on_hosts) {
    const Host<D>& host = surfaces.hosts[on.host];
    if (renewed[static_cast<std::size_t>(surfaces.parts[host.part].body)]) {
      const HostBefore<D> before(domain, host);
      before.change(on.push);
      before.change(on.rub);
    }
    const auto first =
        std::ranges::lower_bound(surfaces.points, on.host, {}, &ContactPoint<D>::host);
    on.host = first_number(surfaces, static_cast<std::uint32_t>(first - surfaces.points.begin()));
    on_hosts_.push_back(on);
  }
  Comm& comm = *domain.grid.partition.comm;
  entries_of_all(comm, set_back_);
  entries_of_all(comm, kept_);
  entries_of_all(comm, levelled_);
  entries_of_all(comm, on_hosts_);
  entries_of_all(comm, from_walls_);
  std::ranges::sort(from_walls_, {}, &FromWalls<D>::part);
}

template <int D>
void drop_bonds_of_failed(Surfaces<D>& surfaces, const std::vector<LaidPoint<D>>& points) {
  std::vector<bool> gone(points.size(), false);
  for (const LaidPoint<D>& point : points) gone[point.given.number] = point.failed;
  std::erase_if(surfaces.bonds, [&](const Bond<D>& bond) {
    return gone[first_number(surfaces, bond.first)] || gone[first_number(surfaces, bond.second)];
  });
}

template <int D>
void RenewedPoints<D>::uncover(Domain<D>& domain, const std::vector<LaidPoint<D>>& more) {
  for (LaidPoint<D>& point : points_) {
    if (!point.failed) continue;
    point.given.face = no_face;
    point.given.felt_area = 0.0;
    point.given.offset = Vec<double, D>::zero();
  }
  drop_bonds_of_failed(domain.surfaces, points_);
  for (const LaidPoint<D>& point : more) {
    points_.push_back(point);
    points_.back().given.number = static_cast<std::uint32_t>(points_.size() - 1);
  }
}

template <int D>
void RenewedPoints<D>::give_memory(Domain<D>& domain,
                                   const std::vector<std::uint32_t>& point_of) const {
  Surfaces<D>& surfaces = domain.surfaces;
  const auto part_at = [&](std::uint32_t point) -> SurfacePart<D>& {
    return surfaces.parts[surfaces.hosts[surfaces.points[point].host].part];
  };
  surfaces.set_back.clear();
  give_kept(surfaces, point_of, set_back_, [&](auto& one) { surfaces.set_back.push_back(one); });
  std::sort(surfaces.set_back.begin(), surfaces.set_back.end());
  give_kept(surfaces, point_of, kept_, [&](auto& one) { part_at(one.point).kept.push_back(one); });
  give_kept(surfaces, point_of, levelled_,
            [&](auto& one) { part_at(one.point).levelled.push_back(one); });
  for (SurfacePart<D>& part : surfaces.parts) {
    std::sort(part.kept.begin(), part.kept.end());
    std::sort(part.levelled.begin(), part.levelled.end());
  }
  surfaces.on_hosts.clear();
  for (ActingOnHost<D> on : on_hosts_) {
    on.host = surfaces.points[point_of[on.host]].host;
    if (!surfaces.parts[surfaces.hosts[on.host].part].foreign) surfaces.on_hosts.push_back(on);
  }
  std::ranges::sort(surfaces.on_hosts, {}, &ActingOnHost<D>::host);
  for (std::size_t k = 0; k < surfaces.on_hosts.size(); ++k)
    surfaces.place_on_hosts[surfaces.on_hosts[k].host] = static_cast<std::uint32_t>(k + 1);
  // To the first part of the body, whoever has it.
  for (const FromWalls<D>& one : from_walls_) {
    SurfacePart<D>& part = *std::ranges::lower_bound(surfaces.parts, static_cast<int>(one.body), {},
                                                     &SurfacePart<D>::body);
    if (part.foreign) continue;
    part.by_walls.add(one.forces, 1.0);
    part.moment_by_walls += one.moment;
    part.at_walls = true;
  }
}

template <int D>
void RenewedPoints<D>::lay(Domain<D>& domain) {
  if (points_.empty()) return;
  give_memory(domain, lay_points(domain, points_));
  if (domain.surfaces.meet) find_near_points(domain);
}

template <int D>
std::vector<std::uint32_t> lay_points(Domain<D>& domain, const std::vector<LaidPoint<D>>& points) {
  Surfaces<D>& surfaces = domain.surfaces;
  for (Bond<D>& bond : surfaces.bonds) {
    bond.first = first_number(surfaces, bond.first);
    bond.second = first_number(surfaces, bond.second);
  }
  surfaces.given.clear();
  for (const LaidPoint<D>& laid : points) surfaces.given.push_back(laid.given);
  start_parts(domain);
  const std::size_t count = surfaces.points.size();
  std::vector<std::uint32_t> point_of(count);
  surfaces.first_numbers.resize(count);
  surfaces.others.places_at_start.resize(count);
  for (std::uint32_t c = 0; c < count; ++c) {
    const std::uint32_t number = surfaces.given[surfaces.given_of[c]].number;
    point_of[number] = c;
    surfaces.first_numbers[c] = number;
    surfaces.places[c] = points[number].place;
    surfaces.others.places_at_start[c] = points[number].at_start;
  }
  surfaces.given = {};
  surfaces.given_of = {};
  surfaces.moving.clear();
  surfaces.in_touch.clear();
  surfaces.F_on_hosts.clear();
  surfaces.places_of_lists.clear();
  for (Bond<D>& bond : surfaces.bonds) {
    bond.first = point_of[bond.first];
    bond.second = point_of[bond.second];
  }
  std::ranges::stable_sort(surfaces.bonds, {}, &Bond<D>::first);
  return point_of;
}

template <int D>
std::vector<bool> near_themselves(Domain<D>& domain, const std::vector<bool>& bodies) {
  const double h = domain.grid.cell_size, reach = apart_to_touch * h;
  const std::vector<LaidPoint<D>> points = laid_points(domain, bodies);
  const auto is_meant = [&](const LaidPoint<D>& point) {
    return bodies[static_cast<std::size_t>(point.given.body)] && point.given.area > 0.0;
  };
  BoxesOfBodies<D, LaidPoint<D>> boxes(reach);
  for (const LaidPoint<D>& point : points)
    if (is_meant(point)) boxes.add(point.given.body, point.place, point);
  const auto look_at_each_other = [&](const LaidPoint<D>& c, const LaidPoint<D>& q) {
    const Vec<double, D> way = q.place - c.place, in_body = q.at_start - c.at_start;
    return dot(way, way) < reach * reach &&
           dot(in_body, in_body) > std::pow(apart_to_touch * h, 2) &&
           dot(way, c.given.normal) > facing * norm(way) &&
           -dot(way, q.given.normal) > facing * norm(way);
  };
  std::vector<bool> found(bodies.size(), false);
  for (const LaidPoint<D>& c : points) {
    if (!is_meant(c)) continue;
    boxes.for_each_near(c.given.body, c.place, [&](const LaidPoint<D>& q) {
      if (look_at_each_other(c, q)) found[static_cast<std::size_t>(c.given.body)] = true;
    });
  }
  return found;
}

template void drop_bonds_of_failed<2>(Surfaces<2>&, const std::vector<LaidPoint<2>>&);
template void drop_bonds_of_failed<3>(Surfaces<3>&, const std::vector<LaidPoint<3>>&);
template std::vector<LaidPoint<2>> laid_points<2>(Domain<2>&, const std::vector<bool>&);
template std::vector<LaidPoint<3>> laid_points<3>(Domain<3>&, const std::vector<bool>&);
template class RenewedPoints<2>;
template class RenewedPoints<3>;
template std::vector<std::uint32_t> lay_points<2>(Domain<2>&, const std::vector<LaidPoint<2>>&);
template std::vector<std::uint32_t> lay_points<3>(Domain<3>&, const std::vector<LaidPoint<3>>&);
template std::vector<bool> near_themselves<2>(Domain<2>&, const std::vector<bool>&);
template std::vector<bool> near_themselves<3>(Domain<3>&, const std::vector<bool>&);

}  // namespace mpm
