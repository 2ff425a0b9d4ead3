#pragma once
// From particles to nodes, as the transfer of the run says.
#include <type_traits>

#include "mpm/schedule/scatter.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {

/// Scatter from the particles of a patch that deforms, as the transfer of the run says.
template <unsigned what, int D>
void scatter_by_transfer(const Domain<D>& domain, const Patch<D>& patch, const NodeRecords& nodes) {
  const TileGrid<D>& grid = domain.grid;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  with_basis_and_lanes(
      grid, domain.body_of(patch), patch, [&]<BasisModel B>(const B& basis, auto lanes) {
        with_transfer_for<B>(domain, any_share(domain), [&]<class Transfer>(const Transfer&) {
          // Forces are mapped alike by all.
          constexpr bool momentum = (what & gives_momentum) != 0;
          using Gives = std::conditional_t<momentum, typename Transfer::Gives, Flip>;
          scatter_by<Mapping<Gives>, what | (Gives::affine ? gives_affine : 0u), lanes>(
              basis, grid, pool, pool.at.velocity, patch, nodes);
        });
      });
}

}  // namespace mpm
