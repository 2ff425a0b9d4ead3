#include "mpm/surfaces/parts.hpp"

#include <cassert>

#include "mpm/schedule/cell_loop.hpp"
#include "mpm/surfaces/host_motion.hpp"

namespace mpm {
namespace {

/// A point of the last host, or of one that is still to come.
template <int D>
void add_point(Surfaces<D>& surfaces, std::uint32_t host, const GivenPoint<D>& given) {
  surfaces.points.push_back({host, given.offset, given.area});
  surfaces.given_of.push_back(static_cast<std::uint32_t>(&given - surfaces.given.data()));
}

/// The part of a patch whose particles carry some of the points of its body, by their particles.
template <int D>
void add_part(Domain<D>& domain, std::size_t p, std::span<const GivenPoint<D>> of_body) {
  Surfaces<D>& surfaces = domain.surfaces;
  const Patch<D>& patch = domain.grid.patches[p];
  const ParticlePool<D>& pool = domain.pool_of(patch);
  SurfacePart<D> part;
  part.body = patch.body;
  part.tile = patch.tile;
  part.patch = static_cast<std::uint32_t>(p);
  part.first_host = static_cast<std::uint32_t>(surfaces.hosts.size());
  part.first_point = static_cast<std::uint32_t>(surfaces.points.size());
  for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
    for (std::uint32_t k = 0; k < cell.count; ++k) {
      const std::uint32_t row = cell.rows[k];
      const auto own =
          std::ranges::equal_range(of_body, pool.id[row], {}, &GivenPoint<D>::particle);
      if (own.empty()) continue;
      Host<D> host{static_cast<std::uint32_t>(surfaces.parts.size()), row, cell.first_node, {}};
      for (int a = 0; a < D; ++a)
        host.xi[a] = local_coordinate(domain.grid.in_cells(pool.listed(a)[row], a),
                                      cell.cell[static_cast<std::size_t>(a)]);
      for (const GivenPoint<D>& point : own)
        add_point(surfaces, static_cast<std::uint32_t>(surfaces.hosts.size()), point);
      surfaces.hosts.push_back(host);
    }
  });
  part.hosts = static_cast<std::uint32_t>(surfaces.hosts.size()) - part.first_host;
  part.points = static_cast<std::uint32_t>(surfaces.points.size()) - part.first_point;
  if (part.points > 0) surfaces.parts.push_back(part);
}

/// Those of a body that does not deform, by the places of their particles.
template <int D>
void add_part_as_one(Domain<D>& domain, std::size_t first_patch,
                     std::span<const GivenPoint<D>> of_body) {
  Surfaces<D>& surfaces = domain.surfaces;
  SurfacePart<D> part;
  part.body = of_body.front().body;
  part.as_one = true;
  part.patch = static_cast<std::uint32_t>(first_patch);
  part.first_host = static_cast<std::uint32_t>(surfaces.hosts.size());
  part.first_point = static_cast<std::uint32_t>(surfaces.points.size());
  part.hosts = 1;
  surfaces.hosts.push_back({static_cast<std::uint32_t>(surfaces.parts.size()), 0, 0, {}});
  const ParticlePool<D>& pool = domain.pool_of(domain.body_at(part.body));
  surfaces.places.resize(surfaces.points.size());
  for (const Patch<D>& patch : patches_of<D>(domain.grid.patches, part.body))
    for (const std::uint32_t row : pool.rows(patch))
      for (const GivenPoint<D>& point :
           std::ranges::equal_range(of_body, pool.id[row], {}, &GivenPoint<D>::particle)) {
        add_point(surfaces, part.first_host, point);
        surfaces.places.push_back(pool.position_of(row) + point.offset);
      }
  part.points = static_cast<std::uint32_t>(surfaces.points.size()) - part.first_point;
  surfaces.parts.push_back(part);
}

}  // namespace

template <int D>
void start_parts(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<GivenPoint<D>>& given = surfaces.given;
  if (given.empty()) return;
  std::ranges::stable_sort(given, [](const GivenPoint<D>& x, const GivenPoint<D>& y) {
    return x.body != y.body ? x.body < y.body : x.particle < y.particle;
  });
  surfaces.parts.clear();
  surfaces.part_of.clear();
  surfaces.hosts.clear();
  surfaces.points.clear();
  surfaces.places.clear();
  surfaces.given_of.clear();
  for (std::size_t p = 0; p < domain.grid.patches.size(); ++p) {
    const auto own =
        std::ranges::equal_range(given, domain.grid.patches[p].body, {}, &GivenPoint<D>::body);
    if (own.empty()) continue;
    const int body = domain.grid.patches[p].body;
    if (domain.body_at(body).keeps_nodes())
      add_part<D>(domain, p, {own.begin(), own.end()});
    else if (p == 0 || domain.grid.patches[p - 1].body != body)
      add_part_as_one<D>(domain, p, {own.begin(), own.end()});
  }
  surfaces.places.resize(surfaces.points.size());
  surfaces.place_on_hosts.assign(surfaces.hosts.size(), 0);
  surfaces.place_of_motion.assign(surfaces.hosts.size(), 0);
  find_parts(domain);
  place_points(domain);
}

template <int D>
void find_parts(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  const std::vector<Patch<D>>& patches = domain.grid.patches;
  const auto is_of = [](const SurfacePart<D>& part, const Patch<D>& patch) {
    return part.body == patch.body && (part.as_one || part.tile == patch.tile);
  };
  const bool known =
      surfaces.part_of.size() == patches.size() &&
      std::ranges::all_of(surfaces.parts, [&](const SurfacePart<D>& part) {
        return part.patch < patches.size() && is_of(part, patches[part.patch]) &&
               !(part.as_one && part.patch > 0 && is_of(part, patches[part.patch - 1]));
      });
  if (known) return;
  surfaces.part_of.assign(patches.size(), -1);
  std::size_t p = 0;  // both are by body, then by tile
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k) {
    while (!is_of(surfaces.parts[k], patches[p])) ++p;
    assert(p < patches.size());
    surfaces.parts[k].patch = static_cast<std::uint32_t>(p);
    surfaces.part_of[p] = static_cast<std::int32_t>(k);
  }
}

template <int D>
void place_points(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    if (part.as_one) return;
    const ParticlePool<D>& pool = domain.pool_of(domain.body_at(part.body));
    std::uint32_t host = part.first_host;
    Mat<double, D> F = deformation_of(pool, surfaces.hosts[host]);
    for (std::uint32_t c = part.first_point; c < part.first_point + part.points; ++c) {
      const ContactPoint<D>& point = surfaces.points[c];
      if (point.host != host) {
        host = point.host;
        F = deformation_of(pool, surfaces.hosts[host]);
      }
      surfaces.places[c] = pool.position_of(surfaces.hosts[host].row) + product(F, point.offset);
    }
  });
}

template <int D>
void add_work_of_surfaces(Domain<D>& domain, std::size_t patch) {
  const SurfacePart<D>* const part = part_of(domain, patch);
  if (part == nullptr || part->as_one) return;
  PatchSums<D>& sums = domain.sums[patch];
  for (const ActingOnHost<D>& on : acting_on(domain.surfaces, *part)) {
    const HostMotion<D> motion = motion_of<velocity_at>(domain, domain.surfaces.hosts[on.host]);
    sums.surface_push += 0.5 * domain.time_step * motion.power(on.push);
    sums.surface_rub += 0.5 * domain.time_step * motion.power(on.rub);
  }
}

template void add_work_of_surfaces<2>(Domain<2>&, std::size_t);
template void add_work_of_surfaces<3>(Domain<3>&, std::size_t);
template void start_parts<2>(Domain<2>&);
template void start_parts<3>(Domain<3>&);
template void find_parts<2>(Domain<2>&);
template void find_parts<3>(Domain<3>&);
template void place_points<2>(Domain<2>&);
template void place_points<3>(Domain<3>&);

}  // namespace mpm
