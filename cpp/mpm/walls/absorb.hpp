#pragma once
// Absorbing walls: dashpots on the nodes of a face let the waves of the bodies before it pass, with
// the traction -rho c_p v along the normal and -rho c_s v along the face (Lysmer & Kuhlemeyer 1969,
// eqs. 1-2 with a = b = 1).
#include "mpm/ledger/work.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/nodes_around.hpp"

namespace mpm {

/// Add a patch's dashpots to its nodes: C_i += rho c A_p N_i [kg/s]. A particle in the cells along
/// a face stands for its initial volume over the cell size of the face, so that the area does not
/// change while particles move about within these cells; N_i are the linear functions on the face.
template <int D>
void scatter_dashpots(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
                      const Patch<D>& patch, const NodeBlock<D>& block) {
  if (!patch.at_wall) return;
  // Do particles with this node at the lower corner around them lie along a face? The cells inside
  // it alone count, one deep: what has gone through the face carries no dashpot.
  const auto along_face = [&](int node, int normal, int side) {
    return grid.walls.face[normal][side] == Wall::absorbing &&
           node == (side == 0 ? 0 : grid.walls.cells[normal] - 1);
  };
  // Of cells: where they are centred at nodes their particles lie on both sides of the own node, so
  // two lower corners are possible.
  const auto may_lie_along_face = [&](const Index<D>& cell) {
    bool any = false;
    for (int normal = 0; normal < D; ++normal)
      for (int side = 0; side < 2; ++side)
        for (int before = 0; before <= grid.reach().before; ++before)
          any = any || along_face(cell[static_cast<std::size_t>(normal)] - before, normal, side);
    return any;
  };
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    if (!may_lie_along_face(cell.cell)) return;
    for (std::uint32_t k = 0; k < cell.count; ++k) {
      const std::uint32_t row = cell.rows[k];
      const NodesAround<D> around(grid, pool, patch, cell, row);
      // A_p = m_p / (rho h) with the density of the start [m^2; m in 2D]. A node's mass would give
      // an area too, but one that changes with every displacement: a tenth of a cell would send 10
      // % back (decision 0011).
      const double area = pool.mass()[row] / (body.initial_density * grid.cell_size);
      for (int normal = 0; normal < D; ++normal)
        for (int side = 0; side < 2; ++side) {
          if (!along_face(around.lower[static_cast<std::size_t>(normal)], normal, side)) continue;
          for (int corner = 0; corner < Tile<D>::corners; ++corner) {
            // The nodes on the face: the cube's corners on that side.
            if ((corner >> normal & 1) != side) continue;
            double share = area;
            for (int a = 0; a < D; ++a) {
              if (a == normal) continue;
              // Linear along the face with every basis, from between which nodes the particle is:
              // they sum to 1, so that the whole area is shared out.
              const double xi = local_coordinate(around.place[a], around.lower[a]);
              share *= corner >> a & 1 ? xi : 1.0 - xi;
            }
            const int node =
                around.first + patch.shape.corner_offset[static_cast<std::size_t>(corner)];
            for (int a = 0; a < D; ++a)
              // rho c_p across the face and rho c_s along it, of the body at the start (Lysmer &
              // Kuhlemeyer 1969). A particle in an edge of the box counts for both faces.
              block.dashpot_factor(a)[node] +=
                  share * (a == normal ? body.pressure_impedance : body.shear_impedance);
          }
        }
    }
  });
}

/// From the dashpots' factors to their forces, which are added to the others:
/// f_i -= C_i (v_i + dv_i / 2), and as dv_i = (f_i + m_i g + f_abs) dt / m_i,
/// f_abs = -C_i (v_i + (f_i / m_i + g) dt / 2) / (1 + C_i dt / (2 m_i)).
/// The velocity in the middle of the step makes them stable for every time step, and they never
/// give energy. With v_i at the start the limit would be below that of waves where particles have
/// moved off the wall; with that at the end a wave of ten cells comes back by some per cent, for
/// the lag (decision 0011).
template <int D>
void add_dashpot_forces(const Patch<D>& patch, const NodeBlock<D>& block,
                        const Vec<double, D>& gravity, double time_step) {
  if (!patch.at_wall) return;
  for (int a = 0; a < D; ++a)
    for (int n = 0; n < block.count; ++n) {
      double& dashpot = block.dashpot_factor(a)[n];  // which becomes the force
      const double m = block.mass()[n];
      // Elsewhere the factor is 0 already and is its force.
      if (!(dashpot > 0.0 && m > 0.0)) continue;
      const double half = 0.5 * time_step / m;
      const double middle = block.velocity(a)[n] + half * (block.force(a)[n] + m * gravity[a]);
      // From kg/s to N, in place: the work is taken with it once nodes are advanced.
      dashpot *= -middle / (1.0 + half * dashpot);
      block.force(a)[n] += dashpot;
    }
}

/// The work of the dashpots on a patch's own nodes, once these are advanced.
template <int D>
Work work_of_dashpots(const NodeBlock<D>& block, const double* own, double time_step) {
  Work work;
  for (int a = 0; a < D; ++a)
    for (int n = 0; n < block.count; ++n) {
      // v - dv is the velocity before the step; with half of f dv it is the work at the middle,
      // -C_i |v + dv / 2|^2 dt but for contact, so never a gain.
      const double f = own[n] * block.dashpot_force(a)[n], dv = block.increment(a)[n];
      work.first += f * (block.velocity(a)[n] - dv);
      work.second += f * dv;
    }
  return {time_step * work.first, 0.5 * time_step * work.second};
}

}  // namespace mpm
