#pragma once
// How hosts of contact points move, by the nodes around them.
#include "mpm/domain.hpp"
#include "mpm/math/inverse.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"

namespace mpm {

/// The patch of a host.
template <int D>
const Patch<D>& patch_of(const Domain<D>& domain, const Host<D>& host) {
  return domain.grid.patches[domain.surfaces.parts[host.part].patch];
}

/// Its motion by the vectors at a number of the records of its nodes.
template <int number, int D>
HostMotion<D> motion_of(Domain<D>& domain, const Host<D>& host) {
  const Patch<D>& patch = patch_of(domain, host);
  const NodeRecords records = domain.grid.block(patch).records;
  const NodeStrides<D> stride(patch.shape);
  HostMotion<D> motion;
  with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    const auto nodes = field_of<B>(records.from(host.first_node), stride);
    const auto w = weights_at(basis, host.xi);
    motion.mean = nodes.template vector<number>(w);
    const auto gradients = nodes.template gradients<number>(w);
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        motion.gradient[a][b] = gradients[static_cast<std::size_t>(a)][b] / domain.grid.cell_size;
  });
  return motion;
}

/// F of a host.
template <int D>
Mat<double, D> deformation_of(const ParticlePool<D>& pool, const Host<D>& host) {
  Mat<double, D> F;
  for (int k = 0; k < D * D; ++k) F[k / D][k % D] = pool.deformation_part(k)[host.row];
  return F;
}

/// t N_ip + (t (x) d) grad_X N_ip to the nodes of a host.
template <int D>
void give_to_nodes_of(Domain<D>& domain, const Host<D>& host, const ForceAtHost<D>& forces) {
  const Patch<D>& patch = patch_of(domain, host);
  const NodeRecords records = domain.grid.block(patch).records;
  with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    if constexpr (B::nodes > 2) {  // bodies that keep their nodes have no other
      const auto w = weights_at(basis, host.xi);
      Index<D> low{}, high;
      high.fill(B::nodes - 1);
      for_each_index<D>(low, high, [&](Index<D> k) {
        double N = 1.0;
        Vec<double, D> dN;
        for (int a = 0; a < D; ++a) dN[a] = 1.0 / domain.grid.cell_size;
        for (std::size_t a = 0; a < D; ++a) {
          const auto along = static_cast<std::size_t>(k[a]);
          N *= w.axis[a].N[along];
          for (std::size_t b = 0; b < D; ++b)
            dN[static_cast<int>(b)] *= b == a ? w.axis[a].dN[along] : w.axis[a].N[along];
        }
        for (std::size_t a = 0; a < D; ++a) k[a] -= B::before;
        double* const numbers = records[host.first_node + patch.shape.distance(k)];
        const Vec<double, D> force = N * forces.force + product(forces.moment, dN);
        for (int a = 0; a < D; ++a) numbers[force_at + a] += force[a];
      });
    }
  });
}

}  // namespace mpm
