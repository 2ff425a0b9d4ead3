#pragma once
// How hosts of contact points move, by the nodes around them.
#include "mpm/domain.hpp"
#include "mpm/math/inverse.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/surfaces/around_host.hpp"

namespace mpm {

/// The patch of a host.
template <int D>
const Patch<D>& patch_of(const Domain<D>& domain, const Host<D>& host) {
  return domain.grid.patches[domain.surfaces.parts[host.part].patch];
}

/// f(AroundHost, way to the first node in reach) of a host. Bodies that keep their nodes have three
/// along an axis.
template <int D, class F>
void with_nodes_around(const Domain<D>& domain, const Host<D>& host, F&& f) {
  const Patch<D>& patch = patch_of(domain, host);
  const NodeStrides<D> stride(patch.shape);
  with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    if constexpr (B::nodes == 3)
      f(AroundHost<D>(weights_at(basis, host.xi), domain.grid.cell_size, stride),
        host.first_node + stride.to_first(B::before));
  });
}

/// Its motion by the vectors at a number of the records of its nodes.
template <int number, int D>
HostMotion<D> motion_of(Domain<D>& domain, const Host<D>& host) {
  const NodeRecords records = domain.grid.block(patch_of(domain, host)).records;
  HostMotion<D> motion;
  with_nodes_around(domain, host, [&](const AroundHost<D>& around, int first) {
    motion = around.motion(records.from(first).at(number));
  });
  return motion;
}

/// The second derivatives of the displacements around a host [1/m].
template <int D>
Mat<double, D> second_derivatives_of(Domain<D>& domain, const Host<D>& host) {
  const HalfRecords displacements = domain.grid.block(patch_of(domain, host)).displacements;
  Mat<double, D> second{};
  with_nodes_around(domain, host, [&](const AroundHost<D>& around, int first) {
    second = around.second_derivatives(displacements.from(first));
  });
  return second;
}

/// F of a host.
template <int D>
Mat<double, D> deformation_of(const ParticlePool<D>& pool, const Host<D>& host) {
  Mat<double, D> F;
  for (int k = 0; k < D * D; ++k) F[k / D][k % D] = pool.deformation_part(k)[host.row];
  return F;
}

template <int D>
Mat<double, D> deformation_of(const Domain<D>& domain, const Host<D>& host) {
  const SurfacePart<D>& part = domain.surfaces.parts[host.part];
  return deformation_of(domain.pool_of(domain.body_at(part.body)), host);
}

/// The deformation of a host of a body that deforms, once find_motions() has found those in touch.
template <int D>
HostDeformation<D> deformation_at(const Domain<D>& domain, std::uint32_t number) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const Host<D>& host = surfaces.hosts[number];
  if (surfaces.parts[host.part].foreign)
    return HostDeformation<D>(host_elsewhere(surfaces, number).deformation);
  const std::uint32_t place = surfaces.place_of_motion[number];
  if (place != 0) return surfaces.in_touch[place - 1].deformation;
  return HostDeformation<D>(deformation_of(domain, host));
}

/// How far a point lies behind the surface [m]. Debris has none: its points lie where its particles
/// are, however these are stretched between pieces.
template <int D>
double behind_surface(const Surfaces<D>& surfaces, const ContactPoint<D>& point) {
  return point.face == no_face ? 0.0 : 0.5 * surfaces.spacing;
}

/// What acts on a host to its nodes.
template <int D>
void give_to_nodes_of(Domain<D>& domain, const Host<D>& host, const ForceAtHost<D>& forces) {
  const NodeRecords records = domain.grid.block(patch_of(domain, host)).records;
  with_nodes_around(domain, host, [&](const AroundHost<D>& around, int first) {
    around.give(records.from(first).at(force_at), forces);
  });
}

}  // namespace mpm
