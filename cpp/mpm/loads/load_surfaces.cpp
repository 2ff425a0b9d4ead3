#include "mpm/comm/all_sums.hpp"
#include "mpm/loads/carried_piece.hpp"
#include "mpm/loads/carry_loads.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// f(force [N], nodes, place [m]) for the pieces of a load that a patch's particles carry; nodes(g)
/// calls g(node, N) for the nodes that carry the middle of the piece. The force and, once nodes are
/// advanced, its work go through this one loop, at the same places, so that the work is exactly
/// that of the force given: particles move later.
template <int D, class F>
void for_each_loaded_piece(Domain<D>& domain, std::size_t p, std::size_t l, F&& f) {
  const TileGrid<D>& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const SurfaceLoad<D>& load = domain.loads[l];
  // A body that is held while the run settles has none until then.
  if (load.body != patch.body || !domain.body_of(patch).deforms()) return;
  ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeBlock<D> block = domain.grid.block(p);
  const auto act = [&](std::uint32_t row, const SurfacePiece<D>& piece, const auto& carried) {
    Vec<double, D> place = carried.place;
    if (patch.keeps)
      carried.nodes([&](int node, double N) {
        for (int a = 0; a < D; ++a) place[a] += N * block.displacements[node][a];
      });
    f(load.force_on(piece_in_space(pool, row, piece)), carried.nodes, place);
  };
  with_basis(grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
      for_each_piece(static_cast<int>(l), pool, cell,
                     [&](std::uint32_t row, SurfacePiece<D>& piece) {
                       with_carried_piece(grid, pool, patch, cell, row, piece.arm, basis,
                                          [&](const auto& carried) { act(row, piece, carried); });
                     });
    });
  });
}

/// The loads of a step: their means over it, and room for the patches' sums.
template <int D>
void start_loads(Domain<D>& domain) {
  // The mean over the time that the force acts, in closed form: the impulse is exact whatever the
  // step's length.
  for (SurfaceLoad<D>& load : domain.loads) {
    const bool keeps = domain.body_at(load.body).keeps_nodes();
    const double from = domain.time - (keeps ? 0.5 * domain.step_before : 0.0),
                 to = from + time_of_forces(domain, keeps);
    for (int a = 0; a < D; ++a)
      load.mean[a] = load.value[static_cast<std::size_t>(a)].mean(load_time(from), load_time(to));
  }
  domain.load_parts.assign(domain.grid.patches.size() * domain.loads.size(),
                           Vec<double, D>::zero());
}

/// f_i += sum over the pieces of N_i(x) f, x the middle of the piece: the surface term of the
/// equation of motion (Sulsky, Chen & Schreyer 1994), with functions that are in balance with a
/// uniform stress as particles give it to nodes. With GIMP and B-splines these are the particle's
/// own, continued to the surface (decision 0071), with the linear basis the linear ones.
template <int D>
void scatter_loads(Domain<D>& domain, std::size_t p) {
  const NodeBlock<D> block = domain.grid.block(p);
  const double acts = time_of_forces(domain, domain.grid.patches[p].keeps);
  for (std::size_t l = 0; l < domain.loads.size(); ++l) {
    Vec<double, D>& total = domain.load_parts[p * domain.loads.size() + l];
    for_each_loaded_piece(
        domain, p, l, [&](const Vec<double, D>& force, auto&& nodes, const Vec<double, D>& place) {
          // Per patch and load, so that no thread adds to another's; summed exactly below.
          total += force;
          if (domain.settles()) domain.sums[p].applied += norm(force);
          domain.sums[p].angular.loads += acts * cross(in_space<D>(place), in_space<D>(force));
          nodes([&](int node, double N) {
            for (int a = 0; a < D; ++a) block.force(a)[node] += N * force[a];
          });
        });
  }
}

}  // namespace

template <int D>
Work work_of_loads(Domain<D>& domain, std::size_t p) {
  const NodeBlock<D> block = domain.grid.block(p);
  Work work;
  for (std::size_t l = 0; l < domain.loads.size(); ++l)
    for_each_loaded_piece(domain, p, l,
                          [&](const Vec<double, D>& force, auto&& nodes, const Vec<double, D>&) {
                            nodes([&](int node, double N) {
                              for (int a = 0; a < D; ++a) {
                                // Before the step the velocity was v - dv; first and half of second
                                // together are the work in the middle of the step.
                                const double f = N * force[a], dv = block.increment(a)[node];
                                work.first += f * (block.velocity(a)[node] - dv);
                                work.second += f * dv;
                              }
                            });
                          });
  return {domain.time_step * work.first, 0.5 * domain.time_step * work.second};
}

template <int D>
void load_surfaces(Domain<D>& domain) {
  if (!domain.has_loads()) return;
  start_loads(domain);
  // Onto the internal forces of the patch's own block, before these are folded and exchanged.
  domain.threads.for_each(domain.grid.patches.size(),
                          [&](std::size_t p) { scatter_loads(domain, p); });
  // Patch by patch, of no order (decision 0038).
  const std::size_t count = domain.loads.size();
  thread_local std::vector<ExactSum> forces;
  forces.assign(D * count, {});
  for (std::size_t k = 0; k < domain.load_parts.size(); ++k)
    for (std::size_t a = 0; a < D; ++a)
      forces[D * (k % count) + a].add(domain.load_parts[k][static_cast<int>(a)]);
  all_sum(*domain.grid.partition.comm, forces);
  for (std::size_t l = 0; l < count; ++l) {
    SurfaceLoad<D>& load = domain.loads[l];
    for (std::size_t a = 0; a < D; ++a) load.force[static_cast<int>(a)] = forces[D * l + a].value();
    load.impulse += time_of_forces(domain, domain.body_at(load.body).keeps_nodes()) * load.force;
  }
}

template void load_surfaces<2>(Domain<2>&);
template void load_surfaces<3>(Domain<3>&);
template Work work_of_loads<2>(Domain<2>&, std::size_t);
template Work work_of_loads<3>(Domain<3>&, std::size_t);

}  // namespace mpm
