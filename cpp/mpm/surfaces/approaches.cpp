#include "mpm/surfaces/approaches.hpp"

#include <algorithm>
#include <tuple>

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

/// One entry for both bodies.
Approach as_pair(int body, Opposite opposite, double speed) {
  if (is_face(opposite) || body <= opposite) return {body, opposite, speed};
  return {opposite, body, speed};
}

}  // namespace

template <int D>
double fastest_approach(const Surfaces<D>& surfaces, int body, Opposite opposite) {
  const Approach wanted = as_pair(body, opposite, 0.0);
  const auto at = std::ranges::lower_bound(surfaces.approaches, wanted, std::less<>{});
  return at != surfaces.approaches.end() && !(wanted < *at) ? at->speed : 0.0;
}

template <int D>
void learn_approaches(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<Approach> faster;
  for (const SurfacePart<D>& part : surfaces.parts)
    for (const auto& [opposite, speed] : part.begun)
      if (!part.foreign && speed > fastest_approach(surfaces, part.body, opposite))
        faster.push_back(as_pair(part.body, opposite, speed));
  entries_of_all(*domain.grid.partition.comm, faster);
  if (faster.empty()) return;
  // Of each pair the fastest is first.
  std::vector<Approach>& all = surfaces.approaches;
  all.insert(all.end(), faster.begin(), faster.end());
  std::ranges::sort(all, [](const Approach& x, const Approach& y) {
    return std::tuple(x.a, x.b, -x.speed) < std::tuple(y.a, y.b, -y.speed);
  });
  const auto again = std::ranges::unique(
      all, [](const Approach& x, const Approach& y) { return x.a == y.a && x.b == y.b; });
  all.erase(again.begin(), again.end());
}

template double fastest_approach<2>(const Surfaces<2>&, int, Opposite);
template double fastest_approach<3>(const Surfaces<3>&, int, Opposite);
template void learn_approaches<2>(Domain<2>&);
template void learn_approaches<3>(Domain<3>&);

}  // namespace mpm
