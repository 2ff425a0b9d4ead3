// Surfaces of bodies that overlap at the start, as particles are no exact picture of a shape.
#include "mpm/contact/set_back.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mpm/comm/all_sums.hpp"
#include "mpm/contact/springs.hpp"
#include "mpm/math/exact_sum.hpp"

namespace mpm {

template <int D>
void set_back_surfaces(Contact<D>& contact, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                       double cell_size) {
  for (const auto& touches : contact.touches)
    for (const Touch<D>& touch : touches) {
      const auto group = [&](std::int32_t b) { return bodies[static_cast<std::size_t>(b)].group; };
      if (law_of(settings, group(touch.body), group(touch.other)).bonded) continue;
      ParticlePool<D>& pool = pools[pool_number(bodies, touch.body)];
      double& share = pool.columns.component(pool.set_back)[pool.order[touch.entry]];
      if (share == 0.0) ++contact.set_back.particles;
      contact.set_back.most = std::max(contact.set_back.most, touch.overlap * cell_size);
      // Of those that touch several bodies the most, in whatever order they come.
      share = std::max(share, (touch.overlap + beyond_overlap) / touch.half);
    }
}

template <int D>
double work_of_pressing(const Contact<D>& contact, const std::vector<Body<D>>& bodies,
                        const ContactSettings& whole, double more, double cell_size, Comm& comm) {
  const auto body = [&](std::int32_t b) -> const Body<D>& {
    return bodies[static_cast<std::size_t>(b)];
  };
  const auto compliance = [&](std::int32_t b) {
    return body(b).deforms() ? 1.0 / body(b).stiffness : 0.0;
  };
  std::array<ExactSum, 1> sum;
  for (const auto& touches : contact.touches)
    for (const Touch<D>& touch : touches) {
      const PairLaw law = law_of(whole, body(touch.body).group, body(touch.other).group);
      const double further = more * law.pressed / cell_size;
      if (law.bonded || further == 0.0) continue;
      const double k = stiffness_of(touch, compliance(touch.body), compliance(touch.other));
      const double without = std::max(touch.overlap - further, 0.0);
      sum[0].add(0.5 * k * (touch.overlap * touch.overlap - without * without));
    }
  all_sum(comm, sum);
  return std::pow(cell_size, D) * sum[0].value();
}

template void set_back_surfaces<2>(Contact<2>&, const std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, const ContactSettings&, double);
template void set_back_surfaces<3>(Contact<3>&, const std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, const ContactSettings&, double);

template double work_of_pressing<2>(const Contact<2>&, const std::vector<Body<2>>&,
                                    const ContactSettings&, double, double, Comm&);
template double work_of_pressing<3>(const Contact<3>&, const std::vector<Body<3>>&,
                                    const ContactSettings&, double, double, Comm&);

}  // namespace mpm
