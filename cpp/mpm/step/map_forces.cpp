#include "mpm/step/absorb.hpp"
#include "mpm/step/loads.hpp"
#include "mpm/step/mirror.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {
namespace {

/// f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial viscosity's pressure q.
template <int D, class Functions>
void scatter_forces(const Functions& basis, const TileGrid<D>& grid, const Body<D>& body,
                    const Patch<D>& patch, const NodeBlock<D>& block) {
  constexpr int W = native_lanes;
  using T = Batch<W>;
  using Nodes = typename Functions::Nodes;
  constexpr int parts = Sym<T, D>::size;
  const double inverse_h = 1.0 / grid.cell_size;
  const bool viscous = body.at.viscosity_pressure >= 0;
  for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
    Nodes f_i[D];
    for (auto& f : f_i) f = Nodes::zero();
    for_each_group(cell, [&](const LaneRows<W>& rows) {
      double xi[D][W], s[parts][W];
      const auto local = local_position(grid, body, cell, rows);
      for (int a = 0; a < D; ++a) local[a].store(xi[a]);
      const T scale = T(-inverse_h) * load(body.volume(), rows);
      const T q = viscous ? load(body.columns.component(body.at.viscosity_pressure), rows) : T(0.0);
      for (int c = 0; c < parts; ++c) {
        T stress = load(body.stress(c), rows);
        if (c < D) stress = stress - q;
        (scale * stress).store(s[c]);
      }
      for (int k = 0; k < rows.count; ++k) {
        Nodes G[D];
        basis.gradients(&xi[0][k], W, G);
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) f_i[a].add(s[Sym<T, D>::index(a, b)][k], G[b]);
      }
    });
    for (int a = 0; a < D; ++a) basis.add_to_nodes(block.force(a) + cell.first_node, f_i[a]);
  });
}

}  // namespace

template <int D>
void map_forces(Domain<D>& domain) {
  auto& grid = domain.grid;
  const bool absorb = grid.walls.absorb(), loaded = domain.has_loads();
  if (loaded) start_loads(domain);
  domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeBlock<D> block = grid.block(p);
    clear_fields(block, 1 + D, grid.fields);
    const Body<D>& body = domain.body_of(patch);
    if (!body.prescribed) subtract_mirrored_weight(domain, patch, block);
    if (body.rigid) return;  // It has no stress.
    with_basis(grid, body, patch,
               [&](const auto& basis) { scatter_forces(basis, grid, body, patch, block); });
    if (absorb) scatter_dashpots(grid, body, patch, block);
    if (loaded) scatter_loads(domain, p);
    fold_at_walls<D>(grid, patch, nullptr, [&](int a) { return block.force(a); });
  });
  grid.sum_shared_nodes(domain.threads, 1 + D, grid.fields);
  if (absorb)
    domain.threads.for_each(grid.patches.size(), [&](std::size_t p) {
      add_dashpot_forces(grid.patches[p], grid.block(p), domain.gravity, domain.time_step);
    });
  if (loaded) sum_loads(domain);
}

template void map_forces<2>(Domain<2>&);
template void map_forces<3>(Domain<3>&);

}  // namespace mpm
