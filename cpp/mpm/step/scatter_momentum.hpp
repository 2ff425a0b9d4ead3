#pragma once
#include "mpm/step/cell_loop.hpp"

namespace mpm {

/// Scatter the mass (if asked for) and the momentum of a patch's particles to its nodes, eqs.
/// (2)-(3). The cell's nodes are the lanes, so that sums stay in registers for all particles of a
/// cell.
template <bool with_mass, int D, class Functions, class Field>
void scatter_momentum(const Functions& basis, const TileGrid<D>& grid, const Body<D>& body,
                      const Patch<D>& patch, double* node_mass, Field&& node_momentum) {
  constexpr int W = native_lanes;
  using Nodes = typename Functions::Nodes;
  for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
    Nodes m_i = Nodes::zero();
    Nodes p_i[D];
    for (auto& p : p_i) p = Nodes::zero();
    for_each_group(cell, [&](const LaneRows<W>& rows) {
      double xi[D][W], v[D][W], m[W];
      const auto local = local_position(grid, body, cell, rows);
      for (int a = 0; a < D; ++a) {
        local[a].store(xi[a]);
        load(body.v(a), rows).store(v[a]);
      }
      load(body.mass(), rows).store(m);
      for (int k = 0; k < rows.count; ++k) {
        Nodes m_ip = Nodes::zero();
        m_ip.add(m[k], basis.functions(&xi[0][k], W));
        if constexpr (with_mass) m_i.add(1.0, m_ip);
        for (int a = 0; a < D; ++a) p_i[a].add(v[a][k], m_ip);
      }
    });
    if constexpr (with_mass) basis.add_to_nodes(node_mass + cell.first_node, m_i);
    for (int a = 0; a < D; ++a) basis.add_to_nodes(node_momentum(a) + cell.first_node, p_i[a]);
  });
}

}  // namespace mpm
