#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void activate_tiles(Domain<D>& domain) {
  for (std::size_t p = 0; p < domain.sums.size(); ++p)
    if (domain.sums[p].stress.eroded) domain.grid.patches[p].left_cell = true;
  const bool changed =
      mend_lists(domain.grid, domain.bodies, domain.threads, domain.list_scratch, domain.eroded);
  sort_disordered(domain.bodies, domain.threads);
  domain.sums.assign(domain.grid.patches.size(), {});
  if (changed && domain.has_contact()) domain.contact.connect(domain.grid, domain.bodies);
}

template void activate_tiles<2>(Domain<2>&);
template void activate_tiles<3>(Domain<3>&);

}  // namespace mpm
