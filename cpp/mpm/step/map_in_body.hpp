#pragma once
// Nodal forces where nodes lie in the body, (M2) of kept_nodes.hpp.
#include "mpm/math/inverse.hpp"
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/transfer/flip.hpp"
#include "mpm/step/transfer/mapping.hpp"

namespace mpm {

struct MappingInBody : Mapping<Flip> {
  static constexpr bool finds_lattices = true;  // as particles stay where they are
};

/// -V_p (sigma_p - q_p 1 + s_p) F_p^-T / h of the particles of a patch, to its nodes.
template <int lanes, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void scatter_in_body(const B& basis, const TileGrid<D>& grid,
                                                     const ParticlePool<D>& pool,
                                                     const Patch<D>& patch,
                                                     const NodeRecords& nodes) {
  const LocalPosition<D> local_position(grid, pool);
  const ForceStress<D> stress_of(pool);
  const double minus_per_cell_size = -1.0 / grid.cell_size;
  DoubleBuffer<MappingInBody, gives_forces, D, B, record> cells(NodeStrides<D>(patch.shape), nodes);
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    cells.begin(cell);
    for_each_group<lanes>(cell, [&](const auto& rows) {
      using T = Batch<lanes>;
      auto& to = cells.next();
      const Sym<T, D> stress = stress_of.template of<T>(rows);
      Mat<T, D> F;
      unrolled<D * D>([&](auto k) { F[k / D][k % D] = load(pool.deformation_part(k), rows); });
      const Mat<T, D> inverse = inverse_of(F);
      const T scale = T(minus_per_cell_size) * load(pool.volume(), rows);
      Mat<T, D> tractions;
      unrolled<D>([&](auto a) {
        unrolled<D>([&](auto b) {
          T sum = stress(a, 0) * inverse[b][0];
          unrolled<D - 1>([&](auto j) { sum = fma(stress(a, j + 1), inverse[b][j + 1], sum); });
          tractions[a][b] = scale * sum;
        });
      });
      to.add_tractions(tractions);
      to.place(weights_at(basis, local_position(cell, rows)), rows.count);
    });
    cells.end();
  });
  cells.finish();
}

}  // namespace mpm
