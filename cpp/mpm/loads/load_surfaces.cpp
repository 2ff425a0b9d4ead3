#include <array>

#include "mpm/comm/all_sums.hpp"
#include "mpm/loads/carry_loads.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/nodes_around.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// The middle of a piece: where it is [m], and g(node, N) for the nodes that carry it.
template <class Place, class Nodes>
struct CarriedPiece {
  Place place;
  Nodes nodes;
};

/// By the functions of its particle, N_i + d . grad N_i + sum_k b_k d2N_i/dx_k^2, d the way from
/// there to the piece and b_k those of the basis: of all nodes that the particle gives mass to.
/// They sum to 1 and have the place of the piece for their mean.
template <int D, class B>
auto by_own_functions(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch,
                      const CellRange<D>& cell, std::uint32_t row, const Vec<double, D>& arm,
                      const B& basis) {
  std::array<AxisWeights<double, B::nodes>, D> w;
  Vec<double, D> xi, d, place;
  for (int a = 0; a < D; ++a) {
    const auto k = static_cast<std::size_t>(a);
    xi[a] = local_coordinate(grid.in_cells(pool.listed(a)[row], a), cell.cell[k]);
    w[k] = basis.along(xi[a]);
    // No further than the nodes beside the cell's own, as may be where a particle is stretched.
    const double u = xi[a] - B::own_node;
    d[a] = std::clamp(arm[a] / grid.cell_size, -1.0 - u, 1.0 - u);
    place[a] = grid.origin[a] + grid.cell_size * (cell.cell[k] + xi[a] - B::own_node + d[a]);
  }
  const Vec<double, D> b = second_order_of(basis, xi, d);
  const int first = cell.first_node;
  const BlockShape<D>& shape = patch.shape;
  const auto nodes = [=, &shape](auto&& g) {
    Index<D> low{}, high;
    high.fill(B::nodes - 1);
    for_each_index<D>(low, high, [&](Index<D> i) {
      const auto along = [&](std::size_t a) { return static_cast<std::size_t>(i[a]); };
      double N = 1.0;
      for (std::size_t a = 0; a < D; ++a) N *= w[a].N[along(a)];
      for (std::size_t a = 0; a < D; ++a) {
        const auto k = static_cast<int>(a);
        double more = d[k] * w[a].dN[along(a)] + b[k] * B::second_derivative[along(a)];
        for (std::size_t c = 0; c < D; ++c)
          if (c != a) more *= w[c].N[along(c)];
        N += more;
      }
      for (std::size_t a = 0; a < D; ++a) i[a] -= B::before;
      g(first + shape.distance(i), N);
    });
  };
  return CarriedPiece{place, nodes};
}

/// By the linear functions at the place of the piece, held between the nodes around its particle:
/// they have mass.
template <int D>
auto by_linear_functions(const TileGrid<D>& grid, const ParticlePool<D>& pool,
                         const Patch<D>& patch, const CellRange<D>& cell, std::uint32_t row,
                         const Vec<double, D>& arm) {
  const NodesAround<D> around(grid, pool, patch, cell, row);
  std::array<double, D> xi;
  Vec<double, D> place;
  for (std::size_t k = 0; k < D; ++k) {
    const auto a = static_cast<int>(k);
    const double x = around.place[a] - around.lower[k];
    xi[k] = std::clamp(x + arm[a] / grid.cell_size, 0.0, 1.0);
    place[a] = grid.origin[a] + grid.cell_size * (around.lower[k] + xi[k]);
  }
  const int first = around.first;
  const BlockShape<D>& shape = patch.shape;
  const auto nodes = [=, &shape](auto&& g) {
    for (int corner = 0; corner < Tile<D>::corners; ++corner) {
      double N = 1.0;
      for (std::size_t k = 0; k < D; ++k) N *= corner >> k & 1 ? xi[k] : 1.0 - xi[k];
      g(first + shape.corner_offset[static_cast<std::size_t>(corner)], N);
    }
  };
  return CarriedPiece{place, nodes};
}

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
      for_each_piece(
          static_cast<int>(l), pool, cell, [&](std::uint32_t row, SurfacePiece<D>& piece) {
            if constexpr (ActsOnFaces<B>)
              act(row, piece, by_own_functions(grid, pool, patch, cell, row, piece.arm, basis));
            else
              act(row, piece, by_linear_functions(grid, pool, patch, cell, row, piece.arm));
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
