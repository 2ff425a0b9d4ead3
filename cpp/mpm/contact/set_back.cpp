// Surfaces of bodies that overlap at the start, as particles are no exact picture of a shape.
#include "mpm/contact/set_back.hpp"

#include <algorithm>

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

template void set_back_surfaces<2>(Contact<2>&, const std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, const ContactSettings&, double);
template void set_back_surfaces<3>(Contact<3>&, const std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, const ContactSettings&, double);

}  // namespace mpm
