#pragma once
// The stages of the nodes: a block of threads a tile of nodes, a thread a node. Sums over the
// patches in the order of the tiles, eq. (3), walls, eq. (8).
#include "mpm/device/cuda/node_sums.cuh"

namespace mpm {

template <int D>
__device__ double grid_share_at(const NodeStep<D>& step, std::int32_t body,
                                const AnIndex<D>& node) {
  if (step.other_at_fixed && step.grid.walls.fixes_near(node, 0, 0)) return 1.0;
  return step.grid_share[body];
}

/// Eq. (8) of a node, of which the force has been summed: v and f become those after it. What walls
/// and gravity do goes into the sums.
template <int D>
__device__ void advance_node(const NodeStep<D>& step, std::int32_t body, const AnIndex<D>& node,
                             const Image<D>& ghost, unsigned held_axes, double m, Vec<double, D>& f,
                             Vec<double, D>& v, double (&dv)[3], NodeSums& sums) {
  const Vec<double, D> place = step.grid.position_of(node);
  if (step.has_gravity) {
    if (ghost.exists)
      sums.add_vector(DeviceSum::mass_moment,
                      m * in_three<D>(place - step.grid.position_of(ghost.image.node)));
    else
      sums.add_vector(DeviceSum::mass_moment, m * in_three(place));
  }
  if (held_axes != 0) {
    if (!ghost.exists) {
      Vec<double, D> s = Vec<double, D>::zero();
      for (int a = 0; a < D; ++a)
        if (held_axes >> a & 1u) s[a] = -step.time_step * (f[a] + m * step.gravity[a]);
      sums.add_reaction(DeviceSum::walls, place, s,
                        [&](int a) { return step.grid.walls.faces_holding(node, a); });
    }
    for (int a = 0; a < D; ++a)
      if (held_axes >> a & 1u) f[a] = -m * step.gravity[a];
  }
  const double own = ghost.exists ? 0.0 : 1.0, impulse = m > 0.0 ? step.time_step / m : 0.0;
  StepDamping damping;
  if (step.damping != nullptr) damping = step.damping[body];
  Vec<double, D> drag = Vec<double, D>::zero();
  for (int a = 0; a < D; ++a) {
    const double weight = m * step.gravity[a];
    dv[a] = impulse * (f[a] + weight);
    if (damping.acts()) {
      DampedNode damped{0.0, 0.0};  // at rest without mass
      if (m > 0.0) damped = advance_damped(damping, m, v[a], f[a] + weight, step.time_step);
      dv[a] = damped.increment;
      drag[a] = own * damped.damping;
      sums.of[DeviceSum::damping_first] += step.time_step * drag[a] * v[a];
      sums.of[DeviceSum::damping_second] += 0.5 * step.time_step * drag[a] * dv[a];
    }
    sums.of[DeviceSum::work] += own * f[a] * v[a];
    sums.of[DeviceSum::gravity_first] += own * weight * v[a];
    sums.of[DeviceSum::gravity_second] += own * weight * dv[a];
    v[a] += dv[a];
  }
  if (damping.acts())
    sums.add_vector(DeviceSum::damping_moment, cross_of(in_three(place), in_three(drag)));
}

/// What is done with the forces of nodes when they have been summed: contact may change them before
/// nodes are advanced.
enum class Forces { none, summed, advanced };

/// What is done with the nodes of a tile at once: mass and momentum to velocities; forces to
/// increments, advanced; MUSL's momenta to velocities.
template <class B, int D, bool momentum, Forces with_forces, bool remapped>
__global__ void __launch_bounds__(64)
    sum_nodes(NodeTileView<D> nodes, PartialView partial, NodeStep<D> step) {
  const std::size_t tile = blockIdx.x;
  const int i = threadIdx.x;
  const Index<D> in_tile = Tile<D>::cell_index(i), first = step.grid.first_cell(nodes.tile[tile]);
  Index<D> node;
  for (int a = 0; a < D; ++a) node[a] = first[a] + in_tile[a];
  const bool near_wall = step.grid.walls.exist;
  const Image<D> ghost(step.grid, step.ghosts, node);
  constexpr int half = half_record;
  constexpr bool forces = with_forces != Forces::none;

  // m, p; f: sums over the patches that hold the node.
  double m = 0.0;
  Vec<double, D> p = Vec<double, D>::zero(), f = p, given = p;  // given: f before it is folded
  for (int k = 0; k < Tile<D>::neighbours; ++k) {
    const std::int32_t holder = nodes.holders[tile * Tile<D>::neighbours + k];
    if (holder < 0) continue;
    const Index<D> offset = Tile<D>::offset(k);
    Index<D> in_block;
    bool held = true;
    for (int a = 0; a < D; ++a) {
      in_block[a] = in_tile[a] - Tile<D>::cells * offset[a] - Block<B, D>::low;
      held = held && in_block[a] >= 0 && in_block[a] < Block<B, D>::edge;
    }
    if (!held) continue;
    const std::size_t block = std::size_t(holder) * Block<B, D>::nodes;
    const auto read = [&](const HalfRecord* of, const Index<D>& at, double (&to)[half]) {
      const HalfRecord q = of[block + Block<B, D>::node(at)];
      to[0] = q.x;
      to[1] = q.y;
      to[2] = q.z;
      to[3] = q.w;
    };
    double q[half], r[half];
    if constexpr (momentum || remapped) read(partial.first, in_block, q);
    if constexpr (forces) read(partial.second, in_block, r);
    if constexpr (forces)
      for (int a = 0; a < D; ++a) given[a] += r[a];
    if (step.ghosts && !ghost.exists) {
      // What the patch has given beyond walls to nodes of which this is the image; first what
      // gravity is to lack there, then what is folded, in the order of the block
      // (walls/mirror.hpp).
      const auto for_each_ghost = [&](auto&& use) {
        for_each_imaged<B, D>(step.grid, node, in_block, use);
      };
      double of_ghost[half];
      if constexpr (forces) {
        if (step.weighed[nodes.body[tile]] == 0)
          weigh<B, D>(step.grid, step.gravity, partial.first + block, node, in_block, r);
        for_each_ghost([&](const Index<D>& at, const WallImage<D>& image) {
          read(partial.second, at, of_ghost);
          for (int a = 0; a < D; ++a) r[a] += image.component(of_ghost[a], a);
        });
      }
      if constexpr (momentum || remapped)
        for_each_ghost([&](const Index<D>& at, const WallImage<D>& image) {
          read(partial.first, at, of_ghost);
          const int vector = momentum ? 1 : 0;
          if constexpr (momentum) q[0] += of_ghost[0];
          for (int a = 0; a < D; ++a) q[vector + a] += image.component(of_ghost[vector + a], a);
        });
    }
    if constexpr (momentum) m += q[0];
    if constexpr (momentum || remapped)
      for (int a = 0; a < D; ++a) p[a] += q[(momentum ? 1 : 0) + a];
    if constexpr (forces)
      for (int a = 0; a < D; ++a) f[a] += r[a];
  }

  HalfRecord* const of_node =
      reinterpret_cast<HalfRecord*>(nodes.records) + 2 * (tile * NodeTileView<D>::nodes + i);
  const unsigned held_axes = near_wall ? step.grid.walls.constrained_axes(node) : 0u;
  Vec<double, D> v;
  NodeSums sums;
  const Vec<double, D> place = step.grid.position_of(node);
  if constexpr (momentum) {
    const double inverse = m > 0.0 ? 1.0 / m : 0.0;
    if (step.takes_of_grid && near_wall) {
      const double share = grid_share_at(step, nodes.body[tile], node);
      if (ghost.exists) {
        sums.add_folding(DeviceSum::mapped, step.grid, node, ghost.image, share * p);
      } else if (held_axes != 0) {
        Vec<double, D> s = Vec<double, D>::zero();
        for (int a = 0; a < D; ++a)
          if (held_axes >> a & 1u) s[a] = -share * p[a];
        sums.add_reaction(DeviceSum::mapped, place, s,
                          [&](int a) { return step.grid.walls.faces_holding(node, a); });
      }
    }
    for (int a = 0; a < D; ++a) v[a] = held_axes >> a & 1u ? 0.0 : p[a] * inverse;
    if (ghost.exists) v = Vec<double, D>::zero();  // that of the image, in reflect_nodes
  } else {
    const HalfRecord q = of_node[0];
    m = q.x;
    v = Vec<double, D>{};
    v[0] = q.y;
    v[1] = q.z;
    if constexpr (D == 3) v[D - 1] = q.w;
  }
  if constexpr (forces)
    if (ghost.exists) {
      sums.add_folding(DeviceSum::walls, step.grid, node, ghost.image, step.time_step * given);
      f = Vec<double, D>::zero();
    }
  if constexpr (with_forces == Forces::advanced) {
    double dv[3] = {0.0, 0.0, 0.0};
    advance_node(step, nodes.body[tile], node, ghost, held_axes, m, f, v, dv, sums);
    of_node[1] = {dv[0], dv[1], dv[2], 0.0};
  }
  if constexpr (with_forces == Forces::summed)
    of_node[1] = {f[0], f[1], D == 3 ? f[D - 1] : 0.0, 0.0};
  if constexpr (momentum || with_forces == Forces::advanced)
    of_node[0] = {m, v[0], v[1], D == 3 ? v[D - 1] : 0.0};
  if constexpr (remapped) {
    const double inverse = m > 0.0 ? 1.0 / m : 0.0;
    for (int a = 0; a < D; ++a) p[a] = held_axes >> a & 1u ? 0.0 : p[a] * inverse;
    of_node[1] = {p[0], p[1], D == 3 ? p[D - 1] : 0.0, 0.0};
  }
  if constexpr (momentum || forces)
    sums.write(
        step.sums, step.tiles, tile,
        near_wall || step.damping != nullptr ? int{DeviceSum::of_nodes} : int{DeviceSum::walls});
}

/// Eq. (8) by itself, where contact has changed velocities and forces.
template <int D>
__global__ void __launch_bounds__(64) advance_nodes(NodeTileView<D> nodes, NodeStep<D> step) {
  const std::size_t tile = blockIdx.x;
  const int i = threadIdx.x;
  Index<D> node = Tile<D>::cell_index(i);
  const Index<D> corner = step.grid.first_cell(nodes.tile[tile]);
  for (int a = 0; a < D; ++a) node[a] += corner[a];
  const bool near_wall = step.grid.walls.exist;
  const Image<D> ghost(step.grid, step.ghosts, node);
  double* const numbers = nodes.records + record * (tile * NodeTileView<D>::nodes + i);
  Vec<double, D> v, f;
  for (int a = 0; a < D; ++a) {
    v[a] = numbers[velocity_at + a];
    f[a] = numbers[force_at + a];
  }
  double dv[3] = {0.0, 0.0, 0.0};
  NodeSums sums;
  advance_node(step, nodes.body[tile], node, ghost,
               near_wall ? step.grid.walls.constrained_axes(node) : 0u, numbers[mass_at], f, v, dv,
               sums);
  for (int a = 0; a < D; ++a) {
    numbers[velocity_at + a] = v[a];
    numbers[increment_at + a] = dv[a];
  }
  sums.write(
      step.sums, step.tiles, tile,
      near_wall || step.damping != nullptr ? int{DeviceSum::of_nodes} : int{DeviceSum::walls});
}

/// Nodes beyond walls take what their images have, and what that gives to the ledger: after the
/// velocities (`first`), the increments (`advanced`), or the remapped velocities (`second` alone).
template <int D, bool first, bool second, bool advanced, bool mapped>
__global__ void __launch_bounds__(64) reflect_nodes(NodeTileView<D> nodes, NodeStep<D> step) {
  const std::size_t tile = blockIdx.x;
  const int i = threadIdx.x;
  Index<D> node = Tile<D>::cell_index(i);
  const Index<D> in_tile = node, corner = step.grid.first_cell(nodes.tile[tile]);
  for (int a = 0; a < D; ++a) node[a] += corner[a];
  const Image<D> ghost(step.grid, step.ghosts, node);
  if (!__syncthreads_or(ghost.exists)) return;
  NodeSums sums;
  if (ghost.exists) {
    Index<D> offset, there;
    for (int a = 0; a < D; ++a) {
      const int k = in_tile[a] + ghost.image.node[a] - node[a];
      offset[a] = tile_offset<D>(k);
      there[a] = k - offset[a] * Tile<D>::cells;
    }
    const std::int32_t other =
        nodes.beside[tile * Tile<D>::neighbours + Tile<D>::neighbour(offset)];
    double* const own = nodes.records + record * (tile * NodeTileView<D>::nodes + i);
    if (other >= 0) {
      const double* const image =
          nodes.records +
          record * (std::size_t(other) * NodeTileView<D>::nodes + Tile<D>::cell(there));
      const double m = own[mass_at];
      Vec<double, D> v, dv;
      for (int a = 0; a < D; ++a) {
        v[a] = ghost.image.component(image[velocity_at + a], a);
        dv[a] = ghost.image.component(image[increment_at + a], a);
        if constexpr (first) own[velocity_at + a] = v[a];
        if constexpr (second) own[increment_at + a] = dv[a];
      }
      if constexpr (advanced) {
        for (int a = 0; a < D; ++a) {
          if (!(ghost.image.turned >> a & 1u)) continue;
          const double weight = 2.0 * m * step.gravity[a], change = image[increment_at + a];
          sums.of[DeviceSum::work] += weight * (image[velocity_at + a] - change);
          sums.of[DeviceSum::gravity_first] -= weight * (image[velocity_at + a] - change);
          sums.of[DeviceSum::gravity_second] -= weight * change;
        }
        sums.add_folding(DeviceSum::walls, step.grid, node, ghost.image,
                         m * (step.time_step * step.gravity - dv));
      }
      if constexpr (mapped)
        if (step.takes_of_grid) {
          const Vec<double, D> before = advanced ? v - dv : v;
          sums.add_folding(DeviceSum::mapped, step.grid, node, ghost.image,
                           (-grid_share_at(step, nodes.body[tile], node) * m) * before);
        }
    }
  }
  if constexpr (advanced || mapped) sums.write(step.sums, step.tiles, tile, DeviceSum::of_nodes);
}

}  // namespace mpm
