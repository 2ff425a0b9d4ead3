#include "mpm/surfaces/approaches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mpm/comm/all_sums.hpp"
#include "mpm/comm/letters.hpp"
#include "mpm/surfaces/law.hpp"

namespace mpm {
namespace {

/// One entry for both bodies.
Approach as_pair(int body, Opposite opposite, double speed) {
  if (is_wall(opposite) || body <= opposite) return {body, opposite, speed};
  return {opposite, body, speed};
}

/// The fastest of each pair.
void keep_fastest(std::vector<Approach>& all) {
  std::ranges::sort(all, [](const Approach& x, const Approach& y) {
    return std::tuple(x.a, x.b, -x.speed) < std::tuple(y.a, y.b, -y.speed);
  });
  const auto again = std::ranges::unique(
      all, [](const Approach& x, const Approach& y) { return x.a == y.a && x.b == y.b; });
  all.erase(again.begin(), again.end());
}

/// How fast waves are in a body at the start [m/s]; without end in one that does not deform.
template <int D>
double waves_of(const Domain<D>& domain, int body) {
  const Body<D>& of = domain.body_at(body);
  return std::sqrt(of.stiffness / of.initial_density);
}

/// The fastest so far of a body and an opposite; 0 if they have not touched [m/s].
template <int D>
double fastest_approach(const Surfaces<D>& surfaces, int body, Opposite opposite) {
  const Approach wanted = as_pair(body, opposite, 0.0);
  const auto at = std::ranges::lower_bound(surfaces.approaches, wanted, std::less<>{});
  return at != surfaces.approaches.end() && !(wanted < *at) ? at->speed : 0.0;
}

}  // namespace

template <int D>
double onset_of(const Domain<D>& domain, const SurfacePart<D>& part, Opposite opposite,
                double approach) {
  double waves = waves_of(domain, part.body);
  if (!is_wall(opposite)) waves = std::min(waves, waves_of(domain, opposite));
  const double fastest = std::max(approach, fastest_approach(domain.surfaces, part.body, opposite));
  return std::min(domain.grid.cell_size * fastest / waves,
                  most_onset(domain.grid.cell_size, domain.surfaces.spacing));
}

template <int D>
void bound_onsets(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  double farthest = 0.0, waves = std::numeric_limits<double>::infinity(), fastest = 0.0;
  for (const SurfacePart<D>& part : surfaces.parts) {
    if (!part.foreign) farthest = std::max(farthest, part.square_of_step);
    waves = std::min(waves, waves_of(domain, part.body));
  }
  for (const Approach& one : surfaces.approaches) fastest = std::max(fastest, one.speed);
  // Both surfaces may move; the half more is for slopes above 1 of overlaps that begin.
  constexpr double per_step = 3.0;
  farthest = std::sqrt(all_max(*domain.grid.partition.comm, farthest));
  fastest = std::max(fastest, per_step * farthest / domain.time_step);
  // Rigid bodies alone have no waves: then the quotient may be no number.
  surfaces.longest_onset = std::min(most_onset(domain.grid.cell_size, surfaces.spacing),
                                    domain.grid.cell_size * fastest / waves);
}

template <int D>
void learn_approaches(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<Approach> faster;
  for (const SurfacePart<D>& part : surfaces.parts)
    for (const auto& [opposite, speed] : part.begun)
      if (!part.foreign && speed > fastest_approach(surfaces, part.body, opposite))
        faster.push_back(as_pair(part.body, opposite, speed));
  keep_fastest(faster);
  entries_of_all(*domain.grid.partition.comm, faster);
  if (faster.empty()) return;
  surfaces.approaches.insert(surfaces.approaches.end(), faster.begin(), faster.end());
  keep_fastest(surfaces.approaches);
}

template double onset_of<2>(const Domain<2>&, const SurfacePart<2>&, Opposite, double);
template double onset_of<3>(const Domain<3>&, const SurfacePart<3>&, Opposite, double);
template void bound_onsets<2>(Domain<2>&);
template void bound_onsets<3>(Domain<3>&);
template void learn_approaches<2>(Domain<2>&);
template void learn_approaches<3>(Domain<3>&);

}  // namespace mpm
