// What particles that press surfaces were pushed with goes to their nodes, with its work.
#include "mpm/loads/carried_piece.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/surfaces/kept_of_particle.hpp"
#include "mpm/surfaces/law.hpp"
#include "mpm/surfaces/pressing.hpp"

namespace mpm {
namespace {

/// f(force, which, nodes) for the forces on the particles of a patch that were pressed, which act
/// as long as those on bodies on nodes of their own; nodes(g) calls g(node, N) for the nodes that
/// carry it. That of the springs acts at the particle, by whose place they are pressed; friction at
/// the surface, so that it turns what flows as it turns the other body.
enum class PressedBy { spring, friction };
template <int D, class F>
void for_each_force(Domain<D>& domain, std::size_t p, F&& f) {
  const TileGrid<D>& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  const PressingColumns& at = pool.pressing;
  const double* const opposite = pool.columns.component(at.opposite);
  const double share = time_of_forces(domain, true) / domain.time_step;
  with_basis(grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k) {
        const std::uint32_t row = cell.rows[k];
        if (!(opposite[row] > 0.0)) continue;
        const KeptOfParticle<D> kept(pool, row);
        const Vec<double, D> slip = kept.vector(at.slip), none = Vec<double, D>::zero();
        with_carried_piece(grid, pool, patch, cell, row, none, basis, [&](const auto& piece) {
          f(share * kept.vector(at.force), PressedBy::spring, piece.nodes);
        });
        if (!(dot(slip, slip) > 0.0)) continue;
        with_carried_piece(grid, pool, patch, cell, row, kept.vector(at.arm), basis,
                           [&](const auto& piece) {
                             f((-share * tangential * kept.number(at.stiffness)) * slip,
                               PressedBy::friction, piece.nodes);
                           });
      }
    });
  });
}

}  // namespace

template <int D>
void load_by_particles(Domain<D>& domain, std::size_t p) {
  const NodeBlock<D> block = domain.grid.block(p);
  for_each_force(domain, p, [&](const Vec<double, D>& force, PressedBy, const auto& nodes) {
    nodes([&](int node, double N) {
      for (int a = 0; a < D; ++a) block.force(a)[node] += N * force[a];
    });
  });
}

template <int D>
PressingWork work_of_pressing(Domain<D>& domain, std::size_t p) {
  const NodeBlock<D> block = domain.grid.block(p);
  PressingWork all;
  for_each_force(domain, p, [&](const Vec<double, D>& force, PressedBy by, const auto& nodes) {
    Work& work = by == PressedBy::spring ? all.push : all.rub;
    nodes([&](int node, double N) {
      for (int a = 0; a < D; ++a) {
        const double f = domain.time_step * N * force[a], dv = block.increment(a)[node];
        work.first += f * (block.velocity(a)[node] - dv);
        work.second += 0.5 * f * dv;
      }
    });
  });
  return all;
}

template void load_by_particles<2>(Domain<2>&, std::size_t);
template void load_by_particles<3>(Domain<3>&, std::size_t);
template PressingWork work_of_pressing<2>(Domain<2>&, std::size_t);
template PressingWork work_of_pressing<3>(Domain<3>&, std::size_t);

}  // namespace mpm
