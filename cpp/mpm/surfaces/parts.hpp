#pragma once
#include <span>

#include "mpm/domain.hpp"

namespace mpm {

/// The contact points that were given, with their hosts, once lists are made; and their places.
/// These are sorted.
template <int D>
void start_parts(Domain<D>& domain);

/// f(part) for the parts that this rank has.
template <int D, class F>
void for_each_own_part(Domain<D>& domain, F&& f) {
  auto& parts = domain.surfaces.parts;
  domain.threads.for_each(parts.size(), [&](std::size_t k) {
    if (!parts[k].foreign) f(parts[k]);
  });
}

/// Find the patches of the parts, of which the numbers change as others come and go.
template <int D>
void find_parts(Domain<D>& domain);

/// Where contact points are by now, (S0).
template <int D>
void place_points(Domain<D>& domain);

/// Half of the work of contact between surfaces on a patch, that of the forces at the start of the
/// step, once its nodes are advanced; the other is that of the forces at its end, touch_surfaces().
template <int D>
void add_work_of_surfaces(Domain<D>& domain, std::size_t patch);

/// The part of a patch; null if it has none.
template <int D>
SurfacePart<D>* part_of(Domain<D>& domain, std::size_t patch) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!surfaces.exist() || surfaces.part_of[patch] < 0) return nullptr;
  return &surfaces.parts[static_cast<std::size_t>(surfaces.part_of[patch])];
}

/// What acts on the hosts of a part in the step.
template <int D>
std::span<const ActingOnHost<D>> acting_on(const Surfaces<D>& surfaces,
                                           const SurfacePart<D>& part) {
  const auto first =
      std::ranges::lower_bound(surfaces.on_hosts, part.first_host, {}, &ActingOnHost<D>::host);
  const auto last =
      std::ranges::lower_bound(first, surfaces.on_hosts.end(), part.first_host + part.host_count,
                               {}, &ActingOnHost<D>::host);
  return {first, last};
}

}  // namespace mpm
